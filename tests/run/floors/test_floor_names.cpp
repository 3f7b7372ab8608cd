// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "core/errors.hpp"
#include "run/files/text_file.hpp"
#include "run/floors/floor_names.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_floor_names {

namespace {

Floors floors_at(const std::vector<double>& heights, int first) {
  Floors floors;
  for (const double height_m : heights) {
    Floor floor;
    floor.number = first++;
    floor.height_m = floor.lowest_m = floor.highest_m = height_m;
    floors.floors.push_back(floor);
  }
  return floors;
}

std::string refusal(const std::string& text) {
  return message_of([&] { static_cast<void>(files::FloorNames::parse(text, "floors.toml")); });
}

}  // namespace

TEST_CASE("a name is kept, also when a floor between two known ones shifts the numbers") {
  const TemporaryFolder folder;
  files::FloorNames names = files::FloorNames::read(folder.path());
  const Floors two = floors_at({0.0, 6.1}, 0);
  names.set(folder.path(), two.floors[1], "Second \"quoted\" floor");
  const files::FloorNames again = files::FloorNames::read(folder.path());
  CHECK(again.name_of(two.floors[0]).empty());
  CHECK(again.name_of(two.floors[1]) == "Second \"quoted\" floor");
  const Floors three = floors_at({0.02, 3.05, 6.08}, 0);
  CHECK(again.name_of(three.floors[1]).empty());
  CHECK(again.name_of(three.floors[2]) == "Second \"quoted\" floor");
}

TEST_CASE("naming a floor leaves the other lines of the file as they are, comments included") {
  const TemporaryFolder folder;
  const auto file = folder.path() / files::kFloorNamesFile;
  files::write_text_file(file, "# mine\n[[floor]]\nname = \"Cellar\"  # cold\nheight_m = -3\n");
  const Floors floors = floors_at({-3.0, 0.0}, -1);
  files::FloorNames names = files::FloorNames::read(folder.path());
  names.set(folder.path(), floors.floors[1], "Ground");
  const std::string text = files::read_text_file(file);
  CHECK(text.starts_with("# mine\n[[floor]]\nname = \"Cellar\"  # cold\nheight_m = -3\n"));
  names.set(folder.path(), floors.floors[1], "Lobby");
  const files::FloorNames again = files::FloorNames::read(folder.path());
  CHECK(again.name_of(floors.floors[0]) == "Cellar");
  CHECK(again.name_of(floors.floors[1]) == "Lobby");
}

TEST_CASE("a name on a line with other keys is not replaced") {
  const TemporaryFolder folder;
  const auto file = folder.path() / files::kFloorNamesFile;
  const std::string text = "floor = [{height_m = 0, name = \"A\"}, {height_m = 3, name = \"B\"}]\n";
  files::write_text_file(file, text);
  const Floors floors = floors_at({0.0, 3.0}, 0);
  files::FloorNames names = files::FloorNames::read(folder.path());
  CHECK(names.name_of(floors.floors[1]) == "B");
  CHECK_THROWS_AS(names.set(folder.path(), floors.floors[0], "C"), DataError);
  CHECK(files::read_text_file(file) == text);
}

TEST_CASE("two floors cannot have one name, and a name is a short text without control characters") {
  const TemporaryFolder folder;
  const Floors floors = floors_at({0.0, 3.0}, 0);
  files::FloorNames names;
  names.set(folder.path(), floors.floors[0], "Hall");
  CHECK(message_of([&] { names.set(folder.path(), floors.floors[1], "Hall"); }) ==
        (folder.path() / files::kFloorNamesFile).string() + ":6: name: 'Hall' is the name of another floor");
  CHECK_THROWS_AS(names.set(folder.path(), floors.floors[1], ""), DataError);
  CHECK_THROWS_AS(names.set(folder.path(), floors.floors[1], "a\nb"), DataError);
  CHECK_THROWS_AS(names.set(folder.path(), floors.floors[1], std::string(101, 'x')), DataError);
}

TEST_CASE("a broken floors.toml is refused with file, line, key and rule") {
  CHECK(refusal("[[floor]]\nheight_m = 0\nname = \"A\"\n") == "no error");
  CHECK(refusal("") == "no error");
  CHECK(refusal("[[floor]]\nheight_m = \"0\"\nname = \"A\"\n") ==
        "floors.toml:2:12: height_m: must be a number within -1000000 … 1000000 m");
  CHECK(refusal("[[floor]]\nheight_m = nan\nname = \"A\"\n").find(":2:12: height_m: ") != std::string::npos);
  CHECK(refusal("[[floor]]\nheight_m = 0\n").find(": name: is missing") != std::string::npos);
  CHECK(refusal("[[floor]]\nname = \"A\"\n").find(": height_m: is missing") != std::string::npos);
  CHECK(refusal("[[floor]]\nheight_m = 0\nname = 7\n").find(":3:8: name: must be a text") !=
        std::string::npos);
  CHECK(refusal("[[floor]]\nheight_m = 0\nname = \"A\"\nheigth = 2\n") ==
        "floors.toml:4:10: heigth: is no key of this file");
  CHECK(refusal("floors = 1\n").find("floors: is no key of this file") != std::string::npos);
  CHECK(refusal("floor = 1\n").find("floor: must be tables [[floor]]") != std::string::npos);
  CHECK(refusal("[[floor]\n").starts_with("floors.toml:1:"));
  CHECK(refusal("[[floor]]\nheight_m = 0\nname = \"A\"\n[[floor]]\nheight_m = 3\nname = \"A\"\n")
            .find(":6:8: name: names two floors") != std::string::npos);
}

TEST_CASE("a floor is chosen by number or name, and another word is refused with what there is") {
  const TemporaryFolder folder;
  const Floors floors = floors_at({-3.0, 0.0}, -1);
  files::FloorNames names;
  names.set(folder.path(), floors.floors[0], "Cellar");
  CHECK(files::floor_by(floors, names, "-1").number == -1);
  CHECK(files::floor_by(floors, names, "Cellar").number == -1);
  CHECK(message_of([&] { static_cast<void>(files::floor_by(floors, names, "2")); }) ==
        "'2' is no floor of this map; it has -1 (Cellar), 0");
}

}  // namespace isobar::test::test_floor_names
