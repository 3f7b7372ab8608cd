// SPDX-License-Identifier: BSD-3-Clause
#include "config/assign_value.hpp"

#include <algorithm>
#include <type_traits>

#include "config/retired_words.hpp"
#include "config/setting_rules.hpp"

namespace isobar {
namespace {

/// Visitor of Setting::Target: checks and assigns the value, one overload for each type of target.
class Assign {
 public:
  Assign(const Setting& setting, const TomlPlace& place)
      : setting_(setting), place_(place), node_(place.node()) {}

  void operator()(double* target) const { *target = number(node_); }
  void operator()(bool* target) const {
    if (!node_.is_boolean()) fail();
    *target = *node_.value<bool>();
  }
  void operator()(std::string* target) const { *target = text(); }
  void operator()(Eigen::Vector3d* target) const {
    const toml::array* array = node_.as_array();
    if (array == nullptr || array->size() != 3) fail();
    for (std::size_t i = 0; i < 3; ++i) {
      (*target)[static_cast<Eigen::Index>(i)] = number((*array)[i]);
    }
  }
  void operator()(std::vector<int>* target) const { assign_list(*target); }
  void operator()(std::vector<double>* target) const { assign_list(*target); }
  template <typename Value>
  void operator()(Value* target) const {
    if constexpr (std::is_enum_v<Value>) {
      *target = static_cast<Value>(choice_index());
    } else {
      *target = static_cast<Value>(whole());
    }
  }

 private:
  [[noreturn]] void fail() const { place_.fail_with_value(rule_text(setting_)); }

  template <typename Number>
  void assign_list(std::vector<Number>& target) const {
    const toml::array* array = node_.as_array();
    if (array == nullptr) fail();
    target.clear();
    for (const toml::node& element : *array) {
      if (std::is_integral_v<Number> && !element.is_integer()) fail();
      target.push_back(static_cast<Number>(number(element)));
    }
  }

  [[nodiscard]] double number(const toml::node& node) const {
    if (!node.is_number()) fail();
    const double value = *node.value<double>();
    if (!is_in_range(setting_, value)) fail();
    return value;
  }

  [[nodiscard]] std::int64_t whole() const {
    if (!node_.is_integer()) place_.fail_with_value("must be a whole number" + range_text(setting_));
    const std::int64_t value = *node_.value<std::int64_t>();
    const bool fits = setting_.choices.empty() ? is_in_range(setting_, static_cast<double>(value))
                                               : is_choice(setting_, std::to_string(value));
    if (!fits) fail();
    return value;
  }

  [[nodiscard]] std::size_t choice_index() const {
    const auto& choices = setting_.choices;
    return static_cast<std::size_t>(std::find(choices.begin(), choices.end(), text()) - choices.begin());
  }

  [[nodiscard]] std::string text() const {
    if (!node_.is_string()) {
      place_.fail_with_value(setting_.choices.empty() ? "must be a text in quotation marks"
                                                      : rule_text(setting_));
    }
    std::string value = *node_.value<std::string>();
    const bool fits =
        setting_.choices.empty() ? keeps_rule(setting_.text_rule, value) : is_choice(setting_, value);
    if (!fits) {
      const std::string_view remedy = retired_remedy(setting_.key, value);
      place_.fail_with_value(rule_text(setting_) + (remedy.empty() ? "" : "; " + std::string(remedy)));
    }
    return value;
  }

  const Setting& setting_;
  const TomlPlace& place_;
  const toml::node& node_;
};

}  // namespace

void assign_value(const Setting& setting, const TomlPlace& place) {
  std::visit(Assign(setting, place), setting.target);
}

}  // namespace isobar
