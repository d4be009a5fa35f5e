// The files of eval/web, compiled into the program.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace depthgrid {

std::string_view WebAsset(std::string_view name);

// A page from a template of eval/web: {{file:NAME}} is replaced by that asset, {{data}} by `json`
// and {{title}} by the title. Scripts and data cannot end their <script> element early.
std::string FillPage(std::string_view template_name, std::string_view title, std::string_view json);

namespace internal {
struct WebAsset {
  const char* name;
  const char* text;
};
extern const WebAsset kWebAssets[];
extern const std::size_t kWebAssetCount;
}  // namespace internal

}  // namespace depthgrid
