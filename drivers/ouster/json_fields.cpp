// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/ouster/json_fields.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "core/errors.hpp"

namespace isobar::ouster {
namespace {

std::string number_text(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g", value);
  return text.data();
}

}  // namespace

JsonFields::JsonFields(std::string_view text, const std::string& file) : file_(file) {
  try {
    root_ = nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    const auto line = 1 + std::count(text.begin(), end, '\n');
    throw ConfigError(file_ + ":" + std::to_string(line) + ": is no JSON; the sensor gives its metadata at " +
                      "http://SENSOR/api/v1/sensor/metadata");
  } catch (const nlohmann::json::exception&) {  // a number beyond the range of double
    throw ConfigError(file_ + ": holds a number that is too large: no sensor's metadata");
  }
  if (!root_.is_object()) throw ConfigError(file_ + ": must hold one JSON object, an Ouster's metadata");
}

JsonFields::Found JsonFields::find(Sections sections, const char* key) const {
  for (const char* section : sections) {
    const auto at = root_.find(section);
    if (at == root_.end() || !at->is_object()) continue;
    const auto value = at->find(key);
    if (value != at->end() && !value->is_null()) return {&*value, std::string(section) + "." + key};
  }
  const auto value = root_.find(key);
  if (value != root_.end() && !value->is_null()) return {&*value, key};
  const bool in_sections = sections.size() > 0 && root_.contains(*sections.begin());
  return {nullptr, in_sections ? std::string(*sections.begin()) + "." + key : key};
}

bool JsonFields::has(Sections sections, const char* key) const {
  return find(sections, key).value != nullptr;
}

double JsonFields::checked(const nlohmann::json& value, const std::string& name, Range range) const {
  const double number = value.is_number() ? value.get<double>() : std::nan("");
  if (!(number >= range.low && number <= range.high)) {
    fail(name, "must be " + number_text(range.low) + " to " + number_text(range.high));
  }
  return number;
}

double JsonFields::number(Sections sections, const char* key, Range range) const {
  const Found found = find(sections, key);
  if (found.value == nullptr) fail(found.name, "is missing");
  return checked(*found.value, found.name, range);
}

int JsonFields::integer(Sections sections, const char* key, Range range) const {
  const double value = number(sections, key, range);
  if (value != std::floor(value)) fail(sections, key, "must be a whole number");
  return static_cast<int>(value);
}

std::vector<double> JsonFields::numbers(Sections sections, const char* key, Range range) const {
  const Found found = find(sections, key);
  if (found.value == nullptr) fail(found.name, "is missing");
  if (!found.value->is_array()) fail(found.name, "must be a list of numbers");
  std::vector<double> values;
  for (const auto& value : *found.value) {
    values.push_back(checked(value, found.name + "[" + std::to_string(values.size()) + "]", range));
  }
  return values;
}

std::string JsonFields::text(Sections sections, const char* key) const {
  const Found found = find(sections, key);
  if (found.value == nullptr) fail(found.name, "is missing");
  if (!found.value->is_string()) fail(found.name, "must be a text");
  return found.value->get<std::string>();
}

std::uint64_t JsonFields::identity(Sections sections, const char* key) const {
  const Found found = find(sections, key);
  if (found.value == nullptr) return 0;
  if (found.value->is_number_unsigned()) return found.value->get<std::uint64_t>();
  if (!found.value->is_string()) return 0;
  const auto& text = found.value->get_ref<const std::string&>();
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() ? value : 0;
}

void JsonFields::fail(Sections sections, const char* key, const std::string& rule) const {
  fail(find(sections, key).name, rule);
}

void JsonFields::fail(const std::string& name, const std::string& rule) const {
  throw ConfigError(file_ + ": " + name + ": " + rule);
}

}  // namespace isobar::ouster
