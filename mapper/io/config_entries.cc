// Trees whose keys are themselves key paths, such as the axes of a sweep.
#include "mapper/io/config_tree_impl.h"
#include "mapper/io/yaml_text_impl.h"

namespace depthgrid {

std::vector<ConfigEntry> Config::Entries() const {
  std::vector<ConfigEntry> entries;
  for (const auto& item : tree_->root) {
    ConfigEntry entry;
    entry.key = item.first.Scalar();
    entry.place = PlaceOf(tree_->place, MarkOfKey(item.first, item.second));
    entry.text = FlowText(item.second);
    if (item.second.IsMap()) {
      auto map = std::make_unique<Tree>();
      map->root.reset(item.second);
      map->place = tree_->place;
      entry.map = Config(std::move(map));
    }
    if (item.second.IsSequence()) {
      entry.items.emplace();
      for (const auto& element : item.second) {
        entry.items->push_back(FlowText(element));
      }
    }
    entries.push_back(std::move(entry));
  }
  return entries;
}

}  // namespace depthgrid
