// SPDX-License-Identifier: BSD-3-Clause
#include "config/setting_rules.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string>
#include <type_traits>

#include "config/config_io.hpp"
#include "config/value_text.hpp"
#include "core/errors.hpp"
#include "core/printable_text.hpp"
#include "core/text_list.hpp"

namespace isobar {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : ", ") + word;
  }
  return text;
}

bool consists_of(const std::string& text, std::string_view also) {
  return std::all_of(text.begin(), text.end(), [also](unsigned char c) {
    return std::isalnum(c) != 0 || also.find(static_cast<char>(c)) != std::string_view::npos;
  });
}

bool is_ipv4(const std::string& text) {
  in_addr address{};
  return inet_pton(AF_INET, text.c_str(), &address) == 1;
}

bool is_ipv4_list(const std::string& text) {
  constexpr std::size_t kMaxAddresses = 16;
  const std::vector<std::string> addresses = split_list(text);
  return addresses.size() <= kMaxAddresses && std::all_of(addresses.begin(), addresses.end(), is_ipv4);
}

bool is_name(const std::string& text) {
  return !text.empty() && text.size() <= 100 && consists_of(text, "_/") && text.front() != '/' &&
         text.back() != '/';
}

/// As ROS 2 checks topics and namespaces: its tools cannot subscribe to others.
bool is_ros_name(const std::string& text) {
  if (!is_name(text) || text.find("__") != std::string::npos) return false;
  for (std::size_t part = 0; part != std::string::npos; part = text.find('/', part)) {
    part += text[part] == '/' ? 1 : 0;
    if (text[part] == '/' || std::isdigit(static_cast<unsigned char>(text[part])) != 0) return false;
  }
  return true;
}

/// Rules of text values, in the order of TextRule.
constexpr std::array kTextRules = {
    "must be a text in quotation marks",
    "must be an IPv4 address such as \"0.0.0.0\"",
    "must be empty, or an IPv4 address such as \"192.168.1.201\"",
    "must be empty, or up to 16 IPv4 addresses separated by commas",
    "must be 1 to 100 letters, digits, '_' or '/', with no '/' at the ends",
    "must be empty, or up to 100 letters, digits, '_' or '/', with no '/' at the ends",
    "must be empty, or up to 100 letters, digits, '_' or '/', with no '/' at the front",
    "must be empty, or names or addresses of network interfaces, separated by commas",
    "must be a ROS name: 1 to 100 letters, digits, '_' or '/', each part between '/' beginning with a letter "
    "or "
    "'_' and without \"__\"",
    "must be empty, or a ROS name: up to 100 letters, digits, '_' or '/', each part between '/' beginning "
    "with a "
    "letter or '_' and without \"__\"",
    "must be 1 to 100 letters, digits or '_', beginning with a letter or '_', without \"__\"",
};

struct RuleText {
  const Setting& setting;

  std::string operator()(const double* /*value*/) const { return "must be a number" + range_text(setting); }
  std::string operator()(const bool* /*value*/) const { return "must be true or false"; }
  std::string operator()(const std::string* /*value*/) const {
    return kTextRules.at(static_cast<std::size_t>(setting.text_rule));
  }
  std::string operator()(const Eigen::Vector3d* /*value*/) const {
    return "must be three numbers, each" + range_text(setting);
  }
  std::string operator()(const std::vector<int>* /*value*/) const {
    return "must be a list of whole numbers, each" + range_text(setting);
  }
  std::string operator()(const std::vector<double>* /*value*/) const {
    return "must be a list of numbers, each" + range_text(setting);
  }
  template <typename Integer>
  std::string operator()(const Integer* /*value*/) const {
    return "must be a whole number" + range_text(setting);
  }
};

struct KeepsRule {
  const Setting& setting;

  bool operator()(const double* value) const { return is_in_range(setting, *value); }
  bool operator()(const bool* /*value*/) const { return true; }
  bool operator()(const std::string* value) const {
    return setting.choices.empty() ? keeps_rule(setting.text_rule, *value) : is_choice(setting, *value);
  }
  bool operator()(const Eigen::Vector3d* value) const { return all_in_range(*value); }
  bool operator()(const std::vector<int>* value) const { return all_in_range(*value); }
  bool operator()(const std::vector<double>* value) const { return all_in_range(*value); }
  template <typename Number>
  bool operator()(const Number* value) const {
    if constexpr (std::is_enum_v<Number>) {
      return static_cast<std::size_t>(*value) < setting.choices.size();
    } else if (!setting.choices.empty()) {
      return is_choice(setting, std::to_string(*value));
    } else {
      return is_in_range(setting, static_cast<double>(*value));
    }
  }

 private:
  template <typename Numbers>
  [[nodiscard]] bool all_in_range(const Numbers& numbers) const {
    return std::all_of(numbers.begin(), numbers.end(),
                       [this](auto number) { return is_in_range(setting, static_cast<double>(number)); });
  }
};

}  // namespace

std::string range_text(const Setting& setting) {
  if (!setting.choices.empty() || !std::isfinite(setting.lowest) || !std::isfinite(setting.highest)) {
    return {};
  }
  const std::string unit = setting.unit.empty() ? "" : " " + setting.unit;
  return " within " + number_text(setting.lowest) + " … " + number_text(setting.highest) + unit;
}

std::string rule_text(const Setting& setting) {
  return setting.choices.empty() ? std::visit(RuleText{setting}, setting.target)
                                 : "must be one of " + joined(setting.choices);
}

bool is_in_range(const Setting& setting, double value) {
  return std::isfinite(value) && value >= setting.lowest && value <= setting.highest;
}

bool is_choice(const Setting& setting, const std::string& value) {
  return std::find(setting.choices.begin(), setting.choices.end(), value) != setting.choices.end();
}

bool keeps_rule(TextRule rule, const std::string& text) {
  switch (rule) {
    case TextRule::kAny:
      return true;
    case TextRule::kIpv4:
      return is_ipv4(text);
    case TextRule::kIpv4OrEmpty:
      return text.empty() || is_ipv4(text);
    case TextRule::kIpv4List:
      return is_ipv4_list(text);
    case TextRule::kName:
      return is_name(text);
    case TextRule::kNameOrEmpty:
      return text.empty() || is_name(text);
    case TextRule::kPrefix:
      return text.size() <= 100 && consists_of(text, "_/") && !text.starts_with('/');
    case TextRule::kInterfaces:
      return text.size() <= 200 && consists_of(text, "_.-:@, ");
    case TextRule::kRosName:
      return is_ros_name(text);
    case TextRule::kRosNameOrEmpty:
      return text.empty() || is_ros_name(text);
    case TextRule::kRosNode:
      return is_ros_name(text) && text.find('/') == std::string::npos;
  }
  return false;
}

bool keeps_rule(const Setting& setting) { return std::visit(KeepsRule{setting}, setting.target); }

void check_config(const Config& config, const std::string& source) {
  Config copy = config;
  Problems problems;
  for (const Setting& setting : settings_of(copy)) {
    if (!keeps_rule(setting)) {
      problems.add(source + ": " + setting.key + ": " + rule_text(setting) + " (got " +
                   printable(value_text(setting)) + ")");
    }
  }
  check_together(
      config, [&](const std::string& /*key*/) { return source; }, problems);
  problems.throw_if_any();
}

}  // namespace isobar
