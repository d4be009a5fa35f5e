#include "eval/experiment/default_values.h"

#include <algorithm>
#include <utility>

namespace depthgrid {
namespace {

using internal::SettingValue;

// A visitor to whom values are alike, whatever their type.
template <typename Work>
class EachValue final : public OptionsVisitor {
 public:
  EachValue(std::string group, Work work) : path_(std::move(group)), work_(std::move(work)) {
    if (!path_.empty()) path_ += '.';
  }

  void Number(std::string_view key, double& value, Interval, std::string_view) override {
    work_(Path(key), value);
  }
  void Number(std::string_view key, int& value, Interval, std::string_view) override {
    work_(Path(key), value);
  }
  void Seed(std::string_view key, std::uint64_t& value, std::string_view) override {
    work_(Path(key), value);
  }
  void Flag(std::string_view key, bool& value, std::string_view) override {
    work_(Path(key), value);
  }
  void Text(std::string_view key, std::string& value, std::string_view) override {
    work_(Path(key), value);
  }
  void Numbers(std::string_view key, std::vector<double>& values, Interval,
               std::string_view) override {
    work_(Path(key), values);
  }
  void Tuple(std::string_view key, std::span<double> values, Interval, std::string_view) override {
    std::vector<double> copy(values.begin(), values.end());
    work_(Path(key), copy);
    std::copy(copy.begin(), copy.end(), values.begin());
  }
  void Rows(std::string_view key, std::vector<double>& values, std::size_t, Interval,
            std::string_view) override {
    work_(Path(key), values);
  }
  void PerAxis(std::string_view key, std::array<double, 3>& values, Interval,
               std::string_view) override {
    work_(Path(key), values);
  }

 protected:
  void ChoiceIndex(std::string_view key, int& index, const std::vector<std::string_view>&,
                   std::string_view) override {
    work_(Path(key), index);
  }
  bool Begin(std::string_view key, std::string_view) override {
    path_ += std::string(key) + '.';
    return true;
  }
  void End() override {
    path_.pop_back();
    path_.erase(path_.rfind('.') == std::string::npos ? 0 : path_.rfind('.') + 1);
  }

 private:
  std::string Path(std::string_view key) const { return path_ + std::string(key); }

  std::string path_;  // of the group, with its last dot
  Work work_;
};

}  // namespace

namespace internal {

std::unique_ptr<OptionsVisitor> MakeValueReader(std::vector<SettingValue>& values) {
  const auto read = [&values](const std::string&, const auto& value) {
    values.emplace_back(value);
  };
  return std::make_unique<EachValue<decltype(read)>>("", read);
}

std::unique_ptr<OptionsVisitor> MakeValueSetter(const std::vector<SettingValue>& values,
                                                const std::string& group, IsOneOfKeys keys) {
  const auto set = [&values, keys = std::move(keys), next = std::size_t{0}](const std::string& path,
                                                                            auto& value) mutable {
    const SettingValue& usual = values[next++];
    if (keys(path)) value = std::get<std::decay_t<decltype(value)>>(usual);
  };
  return std::make_unique<EachValue<std::decay_t<decltype(set)>>>(group, set);
}

}  // namespace internal
}  // namespace depthgrid
