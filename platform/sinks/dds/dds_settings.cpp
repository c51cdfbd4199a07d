#include "platform/sinks/dds/dds_settings.hpp"

#include "platform/cells/cell.hpp"

namespace glint {

DdsSettings network_of(const DdsCellSettings& cell) {
  DdsSettings settings;
  settings.domain = cell.domain;
  settings.interface = cell.interface;
  settings.security = cell.security;
  settings.name = cell.name;
  settings.ros_graph = cell.ros_graph;
  return settings;
}

}  // namespace glint
