// SPDX-License-Identifier: BSD-3-Clause
#include "run/floors/floor_names.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <system_error>

#include "core/errors.hpp"
#include "core/toml_text.hpp"
#include "run/files/text_file.hpp"
#include "run/text/bounded_toml.hpp"
#include "run/text/small_file.hpp"

namespace isobar::files {

namespace {

constexpr const char* kHead =
    "# Names of the floors of this map, by the height of their ground in the map frame.\n"
    "# `isobar map floors RUN --name NUMBER=NAME` adds to it; Isobar never overwrites it.\n";
constexpr const char* kFloorsRule = "must be tables [[floor]] with height_m and name";
constexpr double kHighestM = 1e6;

[[noreturn]] void fail(const std::string& file, const toml::node& node, const std::string& key,
                       const std::string& rule) {
  const toml::source_position at = node.source().begin;
  throw DataError(file + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ": " + key + ": " +
                  rule);
}

std::string rule_of_name() {
  return "must be a text of 1 … " + std::to_string(FloorNames::kMostNameBytes) +
         " bytes without control characters";
}

bool is_name(const std::string& name) {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  return !name.empty() && name.size() <= FloorNames::kMostNameBytes &&
         std::none_of(name.begin(), name.end(), is_control);
}

void refuse_other_keys(const std::string& file, const toml::table& table,
                       std::initializer_list<std::string_view> known) {
  for (const auto& [key, node] : table) {
    const bool is_known = std::find(known.begin(), known.end(), key.str()) != known.end();
    if (!is_known) fail(file, node, std::string(key.str()), "is no key of this file");
  }
}

FloorName floor_name(const std::string& file, const toml::table& table) {
  refuse_other_keys(file, table, {"height_m", "name"});
  const toml::node* height = table.get("height_m");
  const toml::node* name = table.get("name");
  if (height == nullptr) fail(file, table, "height_m", "is missing: the height of the floor's ground [m]");
  if (name == nullptr) fail(file, table, "name", "is missing");
  const auto height_m = height->value<double>();
  if (!height->is_number() || !height_m || !(std::abs(*height_m) <= kHighestM)) {
    fail(file, *height, "height_m", "must be a number within -1000000 … 1000000 m");
  }
  const auto text = name->value_exact<std::string>();
  if (!text || !is_name(*text)) fail(file, *name, "name", rule_of_name());
  return {*height_m, *text};
}

toml::table parsed(const std::string& text, const std::string& file) {
  try {
    return text::parse_bounded_toml(text, file);
  } catch (const text::TomlError& error) {
    throw DataError(error.at(file));
  }
}

std::string number_text(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f", value);
  return text.data();
}

// Begin and end of a line, from 1, without its line end.
std::pair<std::size_t, std::size_t> place_of_line(const std::string& text, std::size_t line) {
  std::size_t begin = 0;
  for (std::size_t number = 1; number < line; ++number) begin = text.find('\n', begin) + 1;
  return {begin, std::min(text.find('\n', begin), text.size())};
}

}  // namespace

FloorNames FloorNames::read(const std::filesystem::path& map_directory) {
  const std::filesystem::path path = map_directory / kFloorNamesFile;
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return {};
  const text::SmallFile read = text::read_small_file(path, text::kMostConfigBytes);
  if (!read.refusal.empty()) throw DataError(path.string() + ": " + read.refusal);
  return parse(read.content, path.string());
}

FloorNames FloorNames::parse(const std::string& text, const std::string& file) {
  FloorNames names;
  names.text_ = text;
  const toml::table table = parsed(text, file);
  refuse_other_keys(file, table, {"floor"});
  const toml::node* floors = table.get("floor");
  if (floors == nullptr) return names;
  if (floors->as_array() == nullptr) fail(file, *floors, "floor", kFloorsRule);
  for (const toml::node& node : *floors->as_array()) {
    if (node.as_table() == nullptr) fail(file, node, "floor", kFloorsRule);
    if (names.entries_.size() == kMostNames) fail(file, node, "floor", "must be at most 1000 tables");
    const FloorName next = floor_name(file, *node.as_table());
    for (const Entry& other : names.entries_) {
      if (other.name.name == next.name) fail(file, *node.as_table()->get("name"), "name", "names two floors");
    }
    names.entries_.push_back({next, node.as_table()->get("name")->source().begin.line});
  }
  return names;
}

const FloorNames::Entry* FloorNames::find(const Floor& floor) const {
  const auto distance_m = [&](const Entry& entry) { return std::abs(entry.name.height_m - floor.height_m); };
  const auto nearest =
      std::min_element(entries_.begin(), entries_.end(),
                       [&](const Entry& a, const Entry& b) { return distance_m(a) < distance_m(b); });
  return nearest != entries_.end() && distance_m(*nearest) < kReachM ? &*nearest : nullptr;
}

std::string FloorNames::name_of(const Floor& floor) const {
  const Entry* entry = find(floor);
  return entry != nullptr ? entry->name.name : std::string();
}

void FloorNames::set(const std::filesystem::path& map_directory, const Floor& floor,
                     const std::string& name) {
  const std::filesystem::path path = map_directory / kFloorNamesFile;
  if (!is_name(name)) throw DataError(path.string() + ": name: " + rule_of_name());
  const Entry* own = find(floor);
  for (const Entry& other : entries_) {
    if (&other != own && other.name.name == name) {
      throw DataError(path.string() + ":" + std::to_string(other.line) + ": name: '" + name +
                      "' is the name of another floor");
    }
  }
  std::string text = text_.empty() ? kHead : text_;
  const std::string line = "name = " + quoted_toml(name);
  if (own != nullptr) {
    const auto [begin, end] = place_of_line(text, own->line);
    text.replace(begin, end - begin, line);
  } else {
    if (text.back() != '\n') text += '\n';
    text += "\n[[floor]]\nheight_m = " + number_text(floor.height_m) + "\n" + line + "\n";
  }
  // What was written by hand may have the name on a line with other keys, which would be lost.
  FloorNames next = parse(text, path.string());
  const std::size_t expected = entries_.size() + (own == nullptr ? 1 : 0);
  if (next.entries_.size() != expected || next.name_of(floor) != name) {
    throw DataError(path.string() + ":" + std::to_string(own == nullptr ? 1 : own->line) +
                    ": name: stands on a line with other keys; change it by hand");
  }
  replace_file(path, text);
  *this = std::move(next);
}

const Floor& floor_by(const Floors& floors, const FloorNames& names, const std::string& word) {
  std::string known;
  for (const Floor& floor : floors.floors) {
    const std::string name = names.name_of(floor);
    if (word == std::to_string(floor.number) || (!name.empty() && word == name)) return floor;
    known +=
        (known.empty() ? "" : ", ") + std::to_string(floor.number) + (name.empty() ? "" : " (" + name + ")");
  }
  throw UsageError("'" + word + "' is no floor of this map; it has " + (known.empty() ? "none" : known));
}

}  // namespace isobar::files
