#include "sim/shapes/shapes.h"

#include <functional>
#include <utility>

#include "mapper/core/error.h"
#include "sim/shapes/outline_items.h"
#include "sim/shapes/solid_items.h"

namespace depthgrid {
namespace {

template <typename Shape>
BuiltItem BuildAs(Config& config) {
  WithItem<Shape> read;
  config.Read(read);
  return {read.item, read.shape.Build(config.Place())};
}

using Builder = std::function<BuiltItem(Config&)>;

const std::vector<std::pair<std::string, Builder>>& Builders() {
  static const std::vector<std::pair<std::string, Builder>> builders = {
      {"box", BuildAs<BoxItem>},     {"cylinder", BuildAs<CylinderItem>},
      {"cone", BuildAs<ConeItem>},   {"sphere", BuildAs<SphereItem>},
      {"torus", BuildAs<TorusItem>}, {"superellipsoid", BuildAs<SuperellipsoidItem>},
      {"lathe", BuildAs<LatheItem>}, {"prism", BuildAs<PrismItem>},
      {"tube", BuildAs<TubeItem>},   {"curtain", BuildAs<CurtainItem>},
      {"leaf", BuildAs<LeafItem>},   {"wall", BuildWall},
  };
  return builders;
}

}  // namespace

std::vector<std::string> ShapeNames() {
  std::vector<std::string> names;
  for (const auto& [name, builder] : Builders()) names.push_back(name);
  return names;
}

BuiltItem BuildShape(const std::string& shape, Config& config) {
  for (const auto& [name, builder] : Builders()) {
    if (name == shape) return builder(config);
  }
  Broken("the shape's name is one of ShapeNames()");
}

}  // namespace depthgrid
