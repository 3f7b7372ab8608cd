// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/dds/raw_reader.hpp"

namespace isobar::dds {

std::string ros_type_of(const dds_topic_descriptor_t& descriptor) {
  const std::string name(descriptor.m_typename);
  const std::string package = name.substr(0, name.find("::"));
  std::string type = name.substr(name.rfind("::") + 2);
  if (type.ends_with('_')) type.pop_back();
  return package + "/msg/" + type;
}

}  // namespace isobar::dds
