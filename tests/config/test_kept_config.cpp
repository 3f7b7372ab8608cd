// SPDX-License-Identifier: BSD-3-Clause
// The last good configuration on the disk: read as it was written, or not at all.
#include "config/kept_config.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "config/config_io.hpp"
#include "config/config_layer.hpp"
#include "core/errors.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_kept_config {

namespace {

namespace fs = std::filesystem;

/// A state folder with a kept configuration.
class State {
 public:
  [[nodiscard]] fs::path file() const { return folder_.path() / kKeptConfigFile; }
  [[nodiscard]] fs::path main() const { return folder_.path() / "etc/isobar.toml"; }
  [[nodiscard]] std::string text() const {
    std::ifstream in(file(), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void write(const std::string& text) const { std::ofstream(file(), std::ios::binary) << text; }
  void keep(const Config& config) const { keep_config(file(), main(), {config, 1'795'878'275}); }
  [[nodiscard]] bool is_refused() const {
    try {
      return !read_kept_config(file(), main()).has_value();
    } catch (const ConfigError& error) {
      return std::string(error.what()).starts_with(file().string());
    }
  }

 private:
  TemporaryFolder folder_;
};

}  // namespace

TEST_CASE("a kept configuration has the values of the one that was accepted, whatever they are") {
  const State state;
  CHECK_FALSE(read_kept_config(state.file(), state.main()).has_value());
  const std::vector<std::string> texts{
      "# defaults\n",
      "role = \"base-station\"\ndds.base_station = \"roof\"\n",
      "method = \"4dof\"\nmap.radius_m = 0x32\nmap.cell_m = 3e-1\n",
      "output.directory = \"/tmp/a \\\"b\\\" \\\\ # ä\\u00e4 = [x]\"\n",
      "lidar.xyz_m = [0.1, -2.0, 1e-3]\nlidar.rpy_deg = [0.1, 0.2, 179.999]\n",
      "[barometer.compensation]\nsigma_pa = 2.125\n",
      "dds.peers = \"10.0.0.1,10.0.0.2\"\ndds.topics.pose = \"where\"\ninput.senders = \"10.0.0.9\"\n",
  };
  for (const std::string& text : texts) {
    CAPTURE(text);
    const Config config = parse_config(text, "c.toml");
    state.keep(config);
    const auto kept = read_kept_config(state.file(), state.main());
    REQUIRE(kept.has_value());
    CHECK(config_hash(kept->config) == config_hash(config));
    CHECK(show_config(kept->config) == show_config(config));
    CHECK(kept->since_s == 1'795'878'275);
  }
}

TEST_CASE("a kept file that is cut, or of which one byte differs, is never used") {
  const State state;
  state.keep(parse_config("lidar.port = 2368\n", "c.toml"));
  const std::string whole = state.text();
  REQUIRE_FALSE(state.is_refused());
  for (std::size_t bytes = 0; bytes < whole.size(); bytes += 1 + bytes / 40) {
    CAPTURE(bytes);
    state.write(whole.substr(0, bytes));
    CHECK(state.is_refused());
    std::string changed = whole;
    changed[bytes] = static_cast<char>(changed[bytes] ^ 0x04);
    state.write(changed);
    CHECK(state.is_refused());
    state.write(whole.substr(0, bytes) + std::string(whole.size() - bytes, '\0'));  // XFS after a power cut
    CHECK(state.is_refused());
  }
  state.write(whole + "lidar.port = 1\n");
  CHECK(state.is_refused());
  state.write(whole);
  CHECK_FALSE(state.is_refused());
}

TEST_CASE("a kept file of others is named and not used") {
  const State state;
  const auto message = [&state](const fs::path& main) {
    return message_of([&] { static_cast<void>(read_kept_config(state.file(), main)); });
  };
  state.keep(Config{});
  CHECK(message(state.main().parent_path() / "other.toml").find("belongs to the configuration") !=
        std::string::npos);
  state.write("lidar.port = 2368\n");
  CHECK(message(state.main()).find("its checksum is missing or wrong") != std::string::npos);
  fs::remove(state.file());
  fs::create_directory(state.file());
  CHECK(message(state.main()).find("is a folder") != std::string::npos);
  CHECK_THROWS_AS(state.keep(Config{}), ServiceError);
  fs::remove(state.file());
  fs::create_symlink("/dev/zero", state.file());
  CHECK(message(state.main()).find("is no regular file") != std::string::npos);
}

TEST_CASE("links in the folder's name make no other configuration") {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "real");
  fs::create_directory_symlink("real", folder.path() / "link");
  CHECK(config_identity(folder.path() / "link/isobar.toml") ==
        config_identity(folder.path() / "real/../real/isobar.toml"));
  CHECK(config_identity("/etc/isobar/isobar.toml") != config_identity("/etc/isobar/other.toml"));
}

}  // namespace isobar::test::test_kept_config
