// SPDX-License-Identifier: BSD-3-Clause
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>

#include "config/config_io.hpp"
#include "config/setting.hpp"
#include "config/value_text.hpp"
#include "core/errors.hpp"

namespace isobar {
namespace {

/// The place of a node, and the words of an error there.
class Place {
 public:
  Place(const std::string& file, std::string key, const toml::node& node)
      : file_(file), key_(std::move(key)), node_(node) {}

  [[noreturn]] void fail(const std::string& rule) const {
    const auto& at = node_.source().begin;
    throw ConfigError(file_ + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ": " + key_ +
                      ": " + rule);
  }
  [[noreturn]] void fail_with_value(const std::string& rule) const { fail(rule + " (got " + got() + ")"); }

 private:
  [[nodiscard]] std::string got() const {
    std::ostringstream text;
    if (node_.is_table()) {
      text << "a section";
    } else {
      node_.visit([&text](const auto& node) { text << node; });
    }
    return text.str();
  }

  const std::string& file_;
  std::string key_;
  const toml::node& node_;
};

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : ", ") + word;
  }
  return text;
}

/// Puts one TOML value into the place that a setting names.
class Assign {
 public:
  Assign(const Setting& setting, const toml::node& node, const Place& place)
      : setting_(setting), node_(node), place_(place) {}

  void operator()(double* target) const {
    *target = number(node_, "must be a number" + range_text(setting_));
  }
  void operator()(int* target) const { *target = static_cast<int>(whole()); }
  void operator()(std::uint16_t* target) const { *target = static_cast<std::uint16_t>(whole()); }
  void operator()(std::uint32_t* target) const { *target = static_cast<std::uint32_t>(whole()); }
  void operator()(std::size_t* target) const { *target = static_cast<std::size_t>(whole()); }
  void operator()(bool* target) const {
    if (!node_.is_boolean()) {
      place_.fail_with_value("must be true or false");
    }
    *target = *node_.value<bool>();
  }
  void operator()(std::string* target) const { *target = text(); }
  void operator()(Eigen::Vector3d* target) const {
    const std::string rule = "must be three numbers, each" + range_text(setting_);
    const toml::array* array = node_.as_array();
    if (array == nullptr || array->size() != 3) {
      place_.fail_with_value(rule);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      (*target)[static_cast<Eigen::Index>(i)] = number((*array)[i], rule);
    }
  }
  void operator()(std::vector<int>* target) const {
    list(*target, "must be a list of whole numbers, each" + range_text(setting_),
         [](const toml::node& element) { return element.is_integer(); });
  }
  void operator()(std::vector<double>* target) const {
    list(*target, "must be a list of numbers, each" + range_text(setting_),
         [](const toml::node& element) { return element.is_number(); });
  }
  void operator()(Role* target) const { *target = static_cast<Role>(choice()); }
  void operator()(Method* target) const { *target = static_cast<Method>(choice()); }
  void operator()(Matcher* target) const { *target = static_cast<Matcher>(choice()); }
  void operator()(AirTemperatureMode* target) const { *target = static_cast<AirTemperatureMode>(choice()); }
  void operator()(CompensationModel* target) const { *target = static_cast<CompensationModel>(choice()); }

 private:
  template <typename Number, typename Fits>
  void list(std::vector<Number>& target, const std::string& rule, const Fits& fits) const {
    const toml::array* array = node_.as_array();
    if (array == nullptr) {
      place_.fail_with_value(rule);
    }
    target.clear();
    for (const toml::node& element : *array) {
      if (!fits(element)) {
        place_.fail_with_value(rule);
      }
      target.push_back(static_cast<Number>(number(element, rule)));
    }
  }
  double number(const toml::node& node, const std::string& rule) const {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value || !std::isfinite(*value) || !(*value >= setting_.lowest && *value <= setting_.highest)) {
      place_.fail_with_value(rule);
    }
    return *value;
  }
  std::int64_t whole() const {
    const std::string rule = "must be a whole number" + range_text(setting_);
    if (!node_.is_integer()) {
      place_.fail_with_value(rule);
    }
    const std::int64_t value = *node_.value<std::int64_t>();
    if (!setting_.choices.empty()) {
      if (std::find(setting_.choices.begin(), setting_.choices.end(), std::to_string(value)) ==
          setting_.choices.end()) {
        place_.fail_with_value("must be one of " + join(setting_.choices));
      }
      return value;
    }
    number(node_, rule);
    return value;
  }
  std::size_t choice() const {
    const std::string word = text();
    return static_cast<std::size_t>(std::find(setting_.choices.begin(), setting_.choices.end(), word) -
                                    setting_.choices.begin());
  }
  std::string text() const {
    if (!node_.is_string()) {
      place_.fail_with_value(setting_.choices.empty() ? "must be a text in quotation marks"
                                                      : "must be one of " + join(setting_.choices));
    }
    std::string value = *node_.value<std::string>();
    if (!setting_.choices.empty() &&
        std::find(setting_.choices.begin(), setting_.choices.end(), value) == setting_.choices.end()) {
      place_.fail_with_value("must be one of " + join(setting_.choices));
    }
    if (const char* rule = broken_text_rule(setting_.text_rule, value); rule != nullptr) {
      place_.fail_with_value(rule);
    }
    return value;
  }

  const Setting& setting_;
  const toml::node& node_;
  const Place& place_;
};

/// Number of letters to change, add or drop (Levenshtein).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) {
    row[j] = j;
  }
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0U : 1U)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

std::string nearest_key(const std::vector<Setting>& settings, const std::string& key) {
  constexpr std::size_t kLongestKey = 80;  // the comparison takes the product of both lengths
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(3, key.size() / 3);
  for (const Setting& setting : settings) {
    if (key.size() > kLongestKey) {
      break;
    }
    const std::size_t name_distance =
        key.find('.') == std::string::npos ? edit_distance(key, setting.name()) : kLongestKey;
    const std::size_t distance = std::min(edit_distance(key, setting.key), name_distance);
    if (distance < best_distance) {
      best_distance = distance;
      best = setting.key;
    }
  }
  return best;
}

class Loader {
 public:
  Loader(std::string file, std::vector<Setting>& settings) : file_(std::move(file)), settings_(settings) {}

  void load(const toml::table& table, const std::string& prefix) {
    for (const auto& [name, node] : table) {
      const std::string key = prefix + std::string(name.str());
      const Place place(file_, key, node);
      const auto found = std::find_if(settings_.begin(), settings_.end(),
                                      [&key](const Setting& setting) { return setting.key == key; });
      if (found != settings_.end()) {
        std::visit(Assign(*found, node, place), found->target);
        if (is_for_robots_only(key) && !for_robots_) for_robots_.emplace(place);
      } else if (is_section(key)) {
        if (!node.is_table()) {
          place.fail("must be a section, [" + key + "]");
        }
        load(*node.as_table(), key + ".");
      } else {
        const std::string nearest = nearest_key(settings_, key);
        place.fail(nearest.empty() ? "unknown key" : "unknown key; did you mean " + nearest + "?");
      }
    }
  }

  /// Throws for a key that means nothing to a base station.
  void refuse_robots_keys() const {
    if (for_robots_) {
      for_robots_->fail(
          "means nothing where role = \"base-station\", which only reads a barometer; remove it "
          "(`isobar config show --role base-station` prints the keys that are left)");
    }
  }

 private:
  [[nodiscard]] bool is_section(const std::string& key) const {
    return std::any_of(settings_.begin(), settings_.end(),
                       [&key](const Setting& setting) { return setting.key.starts_with(key + "."); });
  }

  std::string file_;
  std::vector<Setting>& settings_;
  std::optional<Place> for_robots_;  // the first one
};

std::string read_file(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) {
    throw ConfigError(file.string() + ": no such file");
  }
  if (std::filesystem::is_directory(file)) {
    throw ConfigError(file.string() + ": is a folder, must be a TOML file");
  }
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    throw ConfigError(file.string() + ": cannot be read");
  }
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

toml::table parse_toml(std::string_view text, const std::string& file) {
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    const auto& at = error.source().begin;
    throw ConfigError(file + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) +
                      ": is no TOML: " + std::string(error.description()));
  }
}

/// Puts the calibration that `named` names, if any, into `target`. What is shown later is what was used, so
/// the name goes.
void take_compensation(const std::string& config_file, const char* key, std::string& named,
                       CompensationConfig& target) {
  if (named.empty()) {
    return;
  }
  const std::string place = config_file + ": " + key + ": ";
  if (target.model != CompensationModel::kNone) {
    throw ConfigError(place + "must be empty where the section [compensation] of this sensor names a model");
  }
  const std::filesystem::path path = std::filesystem::path(config_file).parent_path() / named;
  if (!std::filesystem::is_regular_file(path)) {
    throw ConfigError(place + "must name a file (" + path.string() + " is none)");
  }
  target = load_compensation(path);
  named.clear();
}

}  // namespace

Config load_config(const std::filesystem::path& file) { return parse_config(read_file(file), file.string()); }

Config parse_config(std::string_view text, const std::string& file) {
  const toml::table root = parse_toml(text, file);
  Config config;
  std::vector<Setting> settings = settings_of(config);
  Loader loader(file, settings);
  loader.load(root, "");
  if (config.role == Role::kBaseStation) loader.refuse_robots_keys();
  take_compensation(file, "barometer.compensation_file", config.barometer.compensation_file,
                    config.prior.compensation);
  take_compensation(file, "base_barometer.compensation_file", config.base_barometer.compensation_file,
                    config.prior.base_compensation);
  check_together(config, file);
  return config;
}

CompensationConfig load_compensation(const std::filesystem::path& file) {
  const std::string name = file.string();
  const toml::table root = parse_toml(read_file(file), name);
  CompensationConfig compensation;
  std::vector<Setting> settings;
  add_compensation_settings("compensation", compensation, settings);
  Loader(name, settings).load(root, "");
  if (!root.contains("compensation")) {
    throw ConfigError(name + ": has no section [compensation]");
  }
  check_compensation(compensation, name + ": compensation.");
  return compensation;
}

}  // namespace isobar
