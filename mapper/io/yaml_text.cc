#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>

#include <optional>
#include <sstream>
#include <unordered_set>
#include <vector>

#include "mapper/core/error.h"
#include "mapper/io/yaml_text_impl.h"

namespace depthgrid {
namespace {

// A value takes a few hundred bytes in the tree, so this is below a gigabyte.
constexpr std::size_t kMaxYamlValues = 1'000'000;

// Checks the text before building a tree. Aliases are rejected: with them a list can contain
// itself, and a few lines can expand to more values than fit in memory.
class BoundsCheck final : public YAML::EventHandler {
 public:
  explicit BoundsCheck(const std::string& place) : place_(place) {}

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { NoteValue(mark, nullptr); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    Fail(mark, "an alias (*name) is not read, write the value itself");
  }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string& value) override {
    NoteValue(mark, &value);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    Begin(mark, false);
  }
  void OnSequenceEnd() override { groups_.pop_back(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    Begin(mark, true);
  }
  void OnMapEnd() override { groups_.pop_back(); }

  // Call at the end of the text: an unclosed list looks like a key until the parser reports it.
  void RequirePlainKeys() const {
    if (odd_key_) Fail(*odd_key_, "a key must be a plain word");
  }

  // The parser's error, but for an unclosed bracket at the one that it has not seen closed: the
  // parser is then at the next bracket or at the end of the text.
  YAML::ParserException AtItsCause(const YAML::ParserException& error) const {
    const bool is_list = error.msg == YAML::ErrorMsg::END_OF_SEQ_FLOW;
    if (groups_.empty() || !(is_list || error.msg == YAML::ErrorMsg::END_OF_MAP_FLOW)) return error;
    return {groups_.back().begin, is_list ? "'[' is not closed" : "'{' is not closed"};
  }

 private:
  struct Group {
    YAML::Mark begin;
    bool is_map = false;
    bool key_is_next = false;
    std::unordered_set<std::string> keys;
  };

  void Begin(const YAML::Mark& mark, bool is_map) {
    NoteValue(mark, nullptr);
    if (groups_.size() >= kMaxYamlDepth) {
      Fail(mark, fmt::format("values are nested deeper than {}", kMaxYamlDepth));
    }
    groups_.push_back({mark, is_map, is_map, {}});
  }

  // `word` is null for a value that is not a plain word.
  void NoteValue(const YAML::Mark& mark, const std::string* word) {
    if (++values_ > kMaxYamlValues) Fail(mark, fmt::format("more than {} values", kMaxYamlValues));
    if (groups_.empty() || !groups_.back().is_map) return;
    Group& map = groups_.back();
    if (map.key_is_next) {
      if (word == nullptr) {
        if (!odd_key_) odd_key_ = mark;
      } else if (!map.keys.insert(*word).second) {
        Fail(mark, "key '" + *word + "' is given twice");
      }
    }
    map.key_is_next = !map.key_is_next;
  }

  [[noreturn]] void Fail(const YAML::Mark& mark, const std::string& rule) const {
    throw InputError(PlaceOf(place_, mark), rule);
  }

  const std::string& place_;
  std::vector<Group> groups_;
  std::size_t values_ = 0;
  std::optional<YAML::Mark> odd_key_;  // the first
};

}  // namespace

std::string PlaceOf(const std::string& place, const YAML::Mark& mark) {
  // Nodes of a copied tree have no mark of their own; yaml-cpp gives them that of the first letter.
  return mark.pos <= 0 ? place : fmt::format("{}:{}", place, mark.line + 1);
}

YAML::Mark MarkOfKey(const YAML::Node& key, const YAML::Node& value) {
  YAML::Mark mark = key.Mark();
  const bool is_first_of_text = mark.pos == 0 && value.Mark().pos > 0;
  if (is_first_of_text) mark.pos = 1;
  return mark;
}

namespace {

// Throws YAML::Exception for text that is not YAML.
YAML::Node Parsed(const std::string& text, const std::string& place) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  BoundsCheck check(place);
  try {
    parser.HandleNextDocument(check);
  } catch (const YAML::ParserException& error) {
    throw check.AtItsCause(error);
  }
  check.RequirePlainKeys();
  return YAML::Load(text);
}

}  // namespace

YAML::Node ParseYaml(const std::string& text, const std::string& place) {
  try {
    return Parsed(text, place);
  } catch (const YAML::Exception& e) {
    const std::string where =
        e.mark.is_null() ? place : fmt::format("{}:{}", place, e.mark.line + 1);
    throw InputError(where, "not valid YAML: " + e.msg);
  }
}

YAML::Node ParseYamlValue(const std::string& text, const std::string& place) {
  try {
    return Parsed(text, place);
  } catch (const YAML::Exception& e) {
    throw InputError(place, "the value is not valid YAML: " + e.msg);
  }
}

}  // namespace depthgrid
