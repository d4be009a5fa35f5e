#include "eval/report/web_assets.h"

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

std::string Replaced(std::string text, std::string_view what, std::string_view with) {
  for (std::size_t at = text.find(what); at != std::string::npos;
       at = text.find(what, at + with.size())) {
    text.replace(at, what.size(), with);
  }
  return text;
}

// "<\/" is "</" in a JavaScript string or regular expression, and in JSON.
std::string InsideScript(std::string_view text) {
  return Replaced(Replaced(std::string(text), "</", "<\\/"), "<!--", "<\\!--");
}

std::string InsideHtml(std::string_view text) {
  return Replaced(Replaced(std::string(text), "&", "&amp;"), "<", "&lt;");
}

std::string Filling(std::string_view token, std::string_view title, std::string_view json) {
  if (token == "data") {
    // "\!" is not valid in JSON; "<!--" can occur only inside a string.
    return Replaced(Replaced(std::string(json), "</", "<\\/"), "<!--", "<\\u0021--");
  }
  if (token == "title") return InsideHtml(title);
  constexpr std::string_view kFile = "file:";
  Require(token.starts_with(kFile), "a page's tokens are data, title and file:NAME");
  const std::string_view name = token.substr(kFile.size());
  return name.ends_with(".js") ? InsideScript(WebAsset(name)) : std::string(WebAsset(name));
}

}  // namespace

std::string_view WebAsset(std::string_view name) {
  for (std::size_t i = 0; i < internal::kWebAssetCount; ++i) {
    if (internal::kWebAssets[i].name == name) return internal::kWebAssets[i].text;
  }
  Broken("a page names files of eval/web");
}

std::string FillPage(std::string_view template_name, std::string_view title,
                     std::string_view json) {
  const std::string_view page = WebAsset(template_name);
  std::string filled;
  std::size_t at = 0;
  while (true) {
    const std::size_t open = page.find("{{", at);
    filled += page.substr(at, open == std::string_view::npos ? open : open - at);
    if (open == std::string_view::npos) return filled;
    const std::size_t close = page.find("}}", open);
    Require(close != std::string_view::npos, "a page's token ends");
    filled += Filling(page.substr(open + 2, close - open - 2), title, json);
    at = close + 2;
  }
}

}  // namespace depthgrid
