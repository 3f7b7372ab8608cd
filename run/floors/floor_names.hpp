// SPDX-License-Identifier: BSD-3-Clause
// Names of floors, given by the user: floors.toml beside the tiles of a map.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/floors/floor.hpp"

namespace isobar::files {

inline constexpr const char* kFloorNamesFile = "floors.toml";

/// A name belongs to a height, not to a number: numbers change when a floor between two known ones is found.
struct FloorName {
  double height_m = 0.0;  ///< of the floor's ground in the map frame
  std::string name;
};

/// Names by height, of one map.
class FloorNames {
 public:
  static constexpr double kReachM = 1.0;  ///< a name is that of the nearest floor within this
  static constexpr std::size_t kMostNames = 1000;
  static constexpr std::size_t kMostNameBytes = 100;

  FloorNames() = default;
  /// Reads DIR/floors.toml; no names without the file.
  /// @throws DataError "file:line:column: key: rule" when it breaks one
  [[nodiscard]] static FloorNames read(const std::filesystem::path& map_directory);
  /// The same from a text. `file`: its name, for errors.
  [[nodiscard]] static FloorNames parse(const std::string& text, const std::string& file);

  /// Name of a floor; empty if it has none.
  [[nodiscard]] std::string name_of(const Floor& floor) const;
  /// Names the floor, in place of its former name; the other lines of the file stay as they are.
  /// @throws DataError when the name is empty, too long, or that of another floor
  /// @throws ServiceError when the file cannot be written
  void set(const std::filesystem::path& map_directory, const Floor& floor, const std::string& name);

 private:
  struct Entry {
    FloorName name;
    std::size_t line = 0;  ///< of the key `name`, from 1
  };
  [[nodiscard]] const Entry* find(const Floor& floor) const;

  std::string text_;  ///< of the file
  std::vector<Entry> entries_;
};

/// The floor of a number or a name. @throws UsageError naming what there is when there is none
[[nodiscard]] const Floor& floor_by(const Floors& floors, const FloorNames& names, const std::string& word);

}  // namespace isobar::files
