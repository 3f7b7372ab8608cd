// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/keys/access.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <optional>
#include <string_view>

#include "core/errors.hpp"
#include "ipc/keys/limits.hpp"

namespace isobar::keys {
namespace {

constexpr std::string_view kHead =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<dds xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
    "xsi:noNamespaceSchemaLocation=\"http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_";
constexpr const char* kTimeFormat = "%Y-%m-%dT%H:%M:%S";

/// "<name>value</name>" and a line feed.
std::string element(const char* name, const std::string& value) {
  return std::string("<") + name + ">" + value + "</" + name + ">\n";
}

std::string domains() {
  return element("domains",
                 element("id_range", element("min", "0") + element("max", std::to_string(kLastDomain))));
}

std::string topics_of(const char* verb, const std::vector<std::string>& expressions) {
  if (expressions.empty()) return {};
  std::string topics;
  for (const std::string& expression : expressions) topics += element("topic", expression);
  return element(verb, element("topics", topics));
}

std::string time_text(std::int64_t unix_s) {
  const std::time_t time = unix_s;
  std::tm parts{};
  std::array<char, 32> text{};
  ::gmtime_r(&time, &parts);
  return {text.data(), std::strftime(text.data(), text.size(), kTimeFormat, &parts)};
}

/// Text between "<name>" and "</name>", from `begin` on; moves `begin` behind it.
std::optional<std::string> next_element(const std::string& text, const std::string& name,
                                        std::size_t& begin) {
  const std::string open = "<" + name + ">";
  const std::size_t first = text.find(open, begin);
  if (first == std::string::npos) return std::nullopt;
  const std::size_t last = text.find("</" + name + ">", first);
  if (last == std::string::npos) return std::nullopt;
  begin = last;
  return text.substr(first + open.size(), last - first - open.size());
}

std::string required_element(const std::string& text, const std::string& name, const std::string& path) {
  std::size_t begin = 0;
  const auto content = next_element(text, name, begin);
  if (!content) throw DataError(path + ": must have an element <" + name + ">");
  return *content;
}

std::int64_t required_time(const std::string& text, const std::string& name, const std::string& path) {
  const std::string time = required_element(text, name, path);
  std::tm parts{};
  if (::strptime(time.c_str(), kTimeFormat, &parts) == nullptr) {
    throw DataError(path + ": <" + name + ">: must be a time such as 2036-11-28T20:15:00");
  }
  return ::timegm(&parts);
}

std::vector<std::string> expressions_of(const std::string& text, const std::string& verb) {
  std::vector<std::string> expressions;
  std::size_t begin = 0;
  while (const auto rule = next_element(text, verb, begin)) {
    std::size_t topic_begin = 0;
    while (const auto topic = next_element(*rule, "topic", topic_begin)) expressions.push_back(*topic);
  }
  return expressions;
}

}  // namespace

std::string governance_text() {
  // Discovery of these topics is signed, too: a forged "this writer has ended" would silence a base station.
  const std::string rule = element(
      "topic_rule", element("topic_expression", "*") + element("enable_discovery_protection", "true") +
                        element("enable_liveliness_protection", "true") +
                        element("enable_read_access_control", "true") +
                        element("enable_write_access_control", "true") +
                        element("metadata_protection_kind", "SIGN_WITH_ORIGIN_AUTHENTICATION") +
                        element("data_protection_kind", "NONE"));
  const std::string domain_rule =
      domains() + element("allow_unauthenticated_participants", "false") +
      element("enable_join_access_control", "true") + element("discovery_protection_kind", "SIGN") +
      element("liveliness_protection_kind", "SIGN") + element("rtps_protection_kind", "NONE") +
      element("topic_access_rules", rule);
  return std::string(kHead) + "governance.xsd\">\n" +
         element("domain_access_rules", element("domain_rule", domain_rule)) + "</dds>\n";
}

Permissions robot_permissions(const std::string& subject, const Validity& validity) {
  return {subject, {}, {"rt/*"}, validity};
}

Permissions station_permissions(const std::string& subject, const std::string& station,
                                const Validity& validity) {
  return {subject, {"rt/" + station + "/*"}, {}, validity};
}

std::string permissions_text(const std::string& name, const Permissions& permissions) {
  const std::string rule =
      domains() + topics_of("publish", permissions.write) + topics_of("subscribe", permissions.read);
  const std::string grant =
      element("subject_name", permissions.subject) +
      element("validity", element("not_before", time_text(permissions.validity.from_s)) +
                              element("not_after", time_text(permissions.validity.until_s))) +
      element("allow_rule", rule) + element("default", "DENY");
  return std::string(kHead) + "permissions.xsd\">\n<permissions>\n<grant name=\"" + name + "\">\n" + grant +
         "</grant>\n</permissions>\n</dds>\n";
}

Permissions parse_permissions(const std::string& text, const std::string& path) {
  return {required_element(text, "subject_name", path),
          expressions_of(text, "publish"),
          expressions_of(text, "subscribe"),
          {required_time(text, "not_before", path), required_time(text, "not_after", path)}};
}

bool covers(const std::vector<std::string>& expressions, const std::string& topic) {
  return std::any_of(expressions.begin(), expressions.end(), [&topic](const std::string& expression) {
    return ::fnmatch(expression.c_str(), topic.c_str(), 0) == 0;
  });
}

}  // namespace isobar::keys
