// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>
#include <unistd.h>

#include "core/errors.hpp"
#include "tests/run/recording/scratch.hpp"
#include "tests/run/tile_store/tiles.hpp"

namespace isobar::test::test_map_folder {

using namespace isobar;  // NOLINT(google-build-using-namespace): a test

namespace {

template <typename Thrown, typename Call>
std::string message_of(Call call) {
  try {
    static_cast<void>(call());
  } catch (const Thrown& error) {
    return error.what();
  }
  return "nothing thrown";
}

}  // namespace

TEST_CASE("a header is read as it was written") {
  const Scratch scratch;
  const MapHeader header{.tile_m = 9.6, .cell_m = 0.3};
  write_map_header(scratch.path(), header);
  CHECK(read_map_header(scratch.path()) == header);
  write_map_header(scratch.path(), {.tile_m = 8.0, .cell_m = 1.0});
  CHECK(read_map_header(scratch.path()) == MapHeader{.tile_m = 8.0, .cell_m = 1.0});
}

TEST_CASE("a header that breaks a rule is refused with file, line, column, key and rule") {
  const Scratch scratch;
  const auto refusal = [&](const std::string& text) {
    scratch.write("map.toml", text);
    return message_of<DataError>([&] { return FileTileStore::open_to_read(scratch.path()); });
  };
  const std::string file = (scratch.path() / "map.toml").string();
  CHECK(refusal("format = 2\ntile_m = 8.0\ncell_m = 0.25\n").starts_with(file + ":1:10: format: must be 1"));
  for (const char* no_whole_number : {"8.3e+72", "1.0", "inf", "nan", "true", "\"1\""}) {
    CAPTURE(no_whole_number);
    CHECK(refusal(std::string("format = ") + no_whole_number + "\n")
              .starts_with(file + ":1:10: format: must be 1"));
  }
  CHECK(refusal("tile_m = 8.0\ncell_m = 0.25\n").starts_with(file + ": format: is missing"));
  CHECK(refusal("format = 1\ntile_m = -8\ncell_m = 0.25\n").starts_with(file + ":2:10: tile_m: must be"));
  CHECK(refusal("format = 1\ntile_m = nan\ncell_m = 0.25\n").starts_with(file + ":2:10: tile_m: must be"));
  CHECK(refusal("format = 1\ntile_m = 8.0\ncell_m = \"a\"\n").starts_with(file + ":3:10: cell_m: must be"));
  CHECK(refusal("format = \n").starts_with(file + ":1:"));
  std::string deep = "a";
  for (int i = 0; i < 30'777; ++i) deep += ".a";
  CHECK(refusal(deep + " = 1\n").find(":1:32: a key has more than 16 parts") != std::string::npos);
  std::filesystem::remove(file);
  CHECK(message_of<DataError>([&] {
          return FileTileStore::open_to_read(scratch.path());
        }).find("holds no map") != std::string::npos);
}

TEST_CASE("a map with another cell size cannot be continued") {
  const Scratch scratch;
  REQUIRE(FileTileStore::create(scratch.path(), {}, {}) != nullptr);
  CHECK(message_of<DataError>([&] {
          return FileTileStore::open_to_continue(scratch.path(), {.tile_m = 16.0, .cell_m = 0.5}, {});
        }).find("requires tiles of 16") != std::string::npos);
}

TEST_CASE("only one process can open a map for writing, and the error in a second one names it") {
  const Scratch scratch;
  const std::string pid = "(process " + std::to_string(getpid()) + ")";
  {
    const auto store = FileTileStore::create(scratch.path(), {}, {});
    REQUIRE(store->put({}, Bytes(10)));
    for (const auto& message :
         {message_of<ServiceError>([&] { return FileTileStore::create(scratch.path(), {}, {}); }),
          message_of<ServiceError>(
              [&] { return FileTileStore::open_to_continue(scratch.path(), {}, {}); })}) {
      CHECK(message.find(pid) != std::string::npos);
      CHECK(message.find("writes this map") != std::string::npos);
    }
    CHECK(store->contains({}));
  }
  CHECK(FileTileStore::open_to_continue(scratch.path(), {}, {})->contains({}));
}

}  // namespace isobar::test::test_map_folder
