// SPDX-License-Identifier: BSD-3-Clause
// A configuration of several files: order, places of errors, refused files, end mark.
#include <doctest/doctest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "config/config_io.hpp"
#include "config/end_mark.hpp"
#include "config/problems.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_config_layers {

namespace {

/// A configuration folder.
class Folder {
 public:
  Folder() { std::filesystem::create_directory(path() / "conf.d"); }
  void write(const std::string& file, const std::string& text) const {
    std::ofstream(path() / file, std::ios::binary) << text;
  }
  [[nodiscard]] std::filesystem::path path() const { return folder_.path() / "isobar"; }
  [[nodiscard]] std::filesystem::path main() const { return path() / "isobar.toml"; }
  [[nodiscard]] std::filesystem::path outside() const { return folder_.path(); }

 private:
  struct Inner : TemporaryFolder {
    Inner() { std::filesystem::create_directory(path() / "isobar"); }
  } folder_;
};

std::vector<std::string> errors_of(const Folder& folder) {
  try {
    load_layers(folder.main());
    return {};
  } catch (const ConfigErrors& errors) {
    return errors.all();
  }
}

bool fails_with(const Folder& folder, const std::string& words) {
  std::string all;
  for (const std::string& error : errors_of(folder)) all += error + "\n";
  CAPTURE(all);
  return all.find(words) != std::string::npos;
}

}  // namespace

TEST_CASE("files of conf.d are read after isobar.toml in the order of their names, the later one wins") {
  const Folder folder;
  folder.write("isobar.toml", "lidar.port = 1000\ndds.domain_id = 1\n");
  folder.write("conf.d/20-site.toml", "\n[lidar]\nport = 2000\n");
  folder.write("conf.d/10-fleet.toml", "lidar.port = 3000\nmethod = \"4dof\"\n");
  folder.write("conf.d/.hidden.toml", "lidar.port = 4000\n");
  folder.write("conf.d/30-site.toml~", "lidar.port = 5000\n");
  const LoadedConfig loaded = load_layers(folder.main());
  CHECK(loaded.config.lidar.port == 2000);
  CHECK(loaded.config.dds.domain_id == 1);
  CHECK(loaded.config.method == Method::k4Dof);
  REQUIRE(loaded.files.size() == 3);
  CHECK(loaded.origins.at("lidar.port").file == loaded.files[2]);
  CHECK(loaded.origins.at("lidar.port").line == 3);
  const std::string shown = show_config(loaded);
  CHECK(shown.find("# From " + loaded.files[2] + ":3\nlidar.port = 2000\n") != std::string::npos);
  CHECK(shown.find("# Hash " + config_hash(loaded.config)) != std::string::npos);
  CHECK(load_config(folder.main()).lidar.port == 2000);
}

TEST_CASE("all errors of all files are told at once, each with its file and line") {
  const Folder folder;
  folder.write("isobar.toml", "methud = 1\n[lidar]\nport = 0\nmodel = \"x\"\n");
  folder.write("conf.d/a.toml", "[map\n");
  folder.write("conf.d/b.toml", "registration.min_range_m = 5\nregistration.max_range_m = 5\n");
  const auto errors = errors_of(folder);
  REQUIRE(errors.size() == 5);
  CHECK(errors[0].find("isobar.toml:1:10: methud: unknown key; did you mean method?") != std::string::npos);
  CHECK(errors[1].find("isobar.toml:3:8: lidar.port: must be") != std::string::npos);
  CHECK(errors[2].find("isobar.toml:4:9: lidar.model: must be one of") != std::string::npos);
  CHECK(errors[3].find("conf.d/a.toml:1:") != std::string::npos);
  CHECK(errors[4].find("conf.d/b.toml:1:28: registration.min_range_m: must be below") != std::string::npos);
}

TEST_CASE("rules between keys hold for the sum of the files") {
  const Folder folder;
  folder.write("isobar.toml", "registration.min_range_m = 5\n");
  folder.write("conf.d/a.toml", "registration.max_range_m = 5\n");
  CHECK(fails_with(folder, "isobar.toml:1:28: registration.min_range_m: must be below"));
  folder.write("conf.d/b.toml", "registration.max_range_m = 50\n");
  CHECK(errors_of(folder).empty());
  folder.write("conf.d/c.toml", "role = \"base-station\"\n");
  CHECK(fails_with(folder, "isobar.toml:1:28: registration.min_range_m: is not used where role"));
}

TEST_CASE("a calibration file is found beside the file that names it") {
  const Folder folder;
  folder.write("isobar.toml", "barometer.compensation_file = \"none.toml\"\n");
  CHECK(fails_with(folder, "isobar.toml:1:31: barometer.compensation_file: must name a file"));
  folder.write("conf.d/a.toml", "barometer.compensation_file = \"here.toml.cal\"\n");
  folder.write("conf.d/here.toml.cal", "[compensation]\nsigma_pa = 2.0\n");
  CHECK(load_layers(folder.main()).config.prior.compensation.sigma_pa == 2.0);
}

TEST_CASE("files that are no configuration are refused, wherever they are") {
  const Folder folder;
  CHECK(fails_with(folder, "isobar.toml: no such file"));
  folder.write("isobar.toml", "");
  CHECK(fails_with(folder, "isobar.toml: is empty"));
  folder.write("isobar.toml", "# defaults\n");
  CHECK(errors_of(folder).empty());
  REQUIRE(mkfifo((folder.path() / "conf.d/a.toml").c_str(), 0600) == 0);
  CHECK(fails_with(folder, "conf.d/a.toml: is no regular file"));
  std::filesystem::remove(folder.path() / "conf.d/a.toml");
  REQUIRE(mknod((folder.path() / "conf.d/a.toml").c_str(), S_IFSOCK | 0600, 0) == 0);
  CHECK(fails_with(folder, "conf.d/a.toml: is no regular file"));
  std::filesystem::remove(folder.path() / "conf.d/a.toml");
  folder.write("conf.d/a.toml", "#" + std::string(64 * 1024, 'x'));
  CHECK(fails_with(folder, "conf.d/a.toml: is larger than 64 KiB"));
  std::filesystem::remove(folder.path() / "conf.d/a.toml");
  for (int i = 0; i < 65; ++i) folder.write("conf.d/" + std::to_string(i) + ".toml", "# x\n");
  CHECK(fails_with(folder, "conf.d: holds more than 64 *.toml files"));
}

TEST_CASE("a link out of the folder is refused, one inside it is followed") {
  const Folder folder;
  std::ofstream(folder.outside() / "outside.toml") << "lidar.port = 1\n";
  folder.write("isobar.toml", "# defaults\n");
  folder.write("real.text", "lidar.port = 7\n");
  std::filesystem::create_symlink(folder.path() / "real.text", folder.path() / "conf.d/a.toml");
  CHECK(load_layers(folder.main()).config.lidar.port == 7);
  std::filesystem::create_symlink("../../outside.toml", folder.path() / "conf.d/b.toml");
  CHECK(fails_with(folder, "conf.d/b.toml: is a link to a file outside"));
  std::filesystem::remove(folder.path() / "conf.d/b.toml");
  std::filesystem::remove(folder.main());
  std::filesystem::create_symlink(folder.outside() / "outside.toml", folder.main());
  CHECK(fails_with(folder, "isobar.toml: is a link to a file outside"));
}

TEST_CASE("a marked file that is cut anywhere is refused") {
  const std::string body = "lidar.port = 2368\n# words\ndds.domain_id = 17\n";
  CHECK(with_end_mark(with_end_mark(body)).find("sha256") == std::string::npos);
  for (const std::string& whole :
       {with_end_mark(body), with_checksum(body), with_checksum(with_end_mark(body))}) {
    CHECK(parse_config(whole, "c.toml").dds.domain_id == 17);
    for (std::size_t bytes = 3; bytes + 1 < whole.size(); ++bytes) {
      const std::string cut = whole.substr(0, bytes);
      if (cut.ends_with("\n" + std::string(kEndMark))) continue;  // all keys are there
      CAPTURE(cut);
      CHECK_THROWS_AS(parse_config(cut, "c.toml"), ConfigError);
    }
  }
  CHECK_THROWS_WITH_AS(parse_config(with_end_mark(body).substr(0, 72), "c.toml"),
                       doctest::Contains("c.toml:2: the file is cut: its top announces"), ConfigError);
}

TEST_CASE("a checksum covers every byte above it, and text below it is refused") {
  const std::string whole = with_checksum("lidar.port = 2368\n");
  CHECK(with_checksum(whole) == whole);
  std::string changed = whole;
  changed[changed.find("2368")] = '3';
  CHECK_THROWS_WITH_AS(parse_config(changed, "c.toml"), doctest::Contains("the checksum of the last line"),
                       ConfigError);
  CHECK_THROWS_WITH_AS(parse_config(whole + "dds.domain_id = 1\n", "c.toml"),
                       doctest::Contains("text follows after the checksum"), ConfigError);
  CHECK(parse_config(with_end_mark("# x\n") + "dds.domain_id = 1\n", "c.toml").dds.domain_id == 1);
}

TEST_CASE("a file without the announcement needs no end mark; a missing line end is noted") {
  const Folder folder;
  folder.write("isobar.toml", "lidar.port = 23");
  const LoadedConfig loaded = load_layers(folder.main());
  CHECK(loaded.config.lidar.port == 23);
  REQUIRE(loaded.notes.size() == 1);
  CHECK(loaded.notes[0].find("isobar.toml:1: the last line has no line end") != std::string::npos);
}

TEST_CASE("the hash depends on the values only") {
  const Config a = parse_config("lidar.port = 7\n", "a.toml");
  const Config b = parse_config("# words\n[lidar]\nport = 7\n", "b.toml");
  CHECK(config_hash(a) == config_hash(b));
  CHECK(config_hash(a) != config_hash(Config{}));
  CHECK(config_hash(a).size() == 12);
}

TEST_CASE("frames of a robot have different names") {
  const auto fails = [](const std::string& text, const char* words) {
    CHECK_THROWS_WITH_AS(parse_config(text, "c.toml"), doctest::Contains(words), ConfigError);
  };
  fails("[dds]\nmap_frame = \"f\"\nodom_frame = \"f\"\nbase_frame = \"f\"\n",
        "c.toml:3:14: dds.odom_frame: must differ from dds.map_frame");
  fails("dds.imu_frame = \"lidar\"\n", "c.toml:1:17: dds.imu_frame: must differ from dds.lidar_frame");
}

TEST_CASE("an error quotes at most 80 characters of a file") {
  const std::string key(60'000, 'k');
  CHECK_THROWS_AS(parse_config(key + " = 1\n", "c.toml"), ConfigError);
  for (const std::string& text :
       {key + " = 1\n", "method = \"" + key + "\"\n", "method = [\"" + key + "\"]\n"}) {
    try {
      parse_config(text, "c.toml");
    } catch (const ConfigError& error) {
      CHECK(std::string(error.what()).size() < 300);
    }
  }
}

}  // namespace isobar::test::test_config_layers
