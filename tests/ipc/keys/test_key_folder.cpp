// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "core/errors.hpp"
#include "ipc/keys/key_folder.hpp"
#include "tests/ipc/keys/key_folders.hpp"
#include "tests/support/message_of.hpp"

namespace isobar::test::test_key_folder {

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kYearS = 31'557'600;

/// What check_key_folder() says about a folder.
std::string fault_of(const fs::path& folder, std::int64_t now_s = keys::unix_now_s()) {
  return message_of([&] { static_cast<void>(keys::check_key_folder(folder, now_s)); });
}

void replace_in(const fs::path& file, const std::string& from, const std::string& to) {
  std::ostringstream content;
  content << std::ifstream(file).rdbuf();
  std::string text = content.str();
  const std::size_t place = text.find(from);
  REQUIRE(place != std::string::npos);
  std::ofstream(file) << text.replace(place, from.size(), to);
}

TEST_CASE("complete keys are accepted, and state whom they are for, for what and until when") {
  const Site site;
  const std::int64_t now_s = keys::unix_now_s();
  const keys::KeyFolder robot = keys::check_key_folder(site.robot, now_s);
  CHECK(robot.subject == "CN=robot,O=isobar");
  CHECK_FALSE(robot.is_station());
  CHECK(std::abs(robot.until_s - now_s - 10 * kYearS) < 60);
  const keys::KeyFolder roof = keys::check_key_folder(site.roof, now_s);
  CHECK(roof.is_station());
  CHECK(roof.station() == "roof");
}

TEST_CASE("keys fit one role: a robot's cannot write, a base station's write below its own name only") {
  const Site site;
  keys::add_member(site.store, {"nested", "site/roof_2"}, 10);
  const std::int64_t now_s = keys::unix_now_s();
  const keys::KeyFolder robot = keys::check_key_folder(site.robot, now_s);
  const keys::KeyFolder roof = keys::check_key_folder(site.roof, now_s);
  keys::check_permitted(robot, {}, {"rt/roof/fluid_pressure", "rt/site/roof_2/temperature"});
  keys::check_permitted(roof, {"rt/roof/fluid_pressure", "rt/roof/temperature"}, {});
  keys::check_permitted(keys::check_key_folder(site.store / "nested", now_s),
                        {"rt/site/roof_2/fluid_pressure"}, {});
  CHECK_THROWS_AS(keys::check_permitted(robot, {"rt/roof/fluid_pressure"}, {}), DataError);
  CHECK_THROWS_AS(keys::check_permitted(roof, {}, {"rt/roof/fluid_pressure"}), DataError);
  CHECK(message_of([&] { keys::check_permitted(roof, {"rt/roof2/fluid_pressure"}, {}); }) ==
        (site.roof / "permissions.p7s").string() +
            ": must permit to write rt/roof2/fluid_pressure: make keys by isobar keys add DIR NAME "
            "--base-station STATION");
}

TEST_CASE("each missing file is named") {
  for (const char* name : {"identity_ca.pem", "permissions_ca.pem", "governance.p7s", "certificate.pem",
                           "key.pem", "permissions.p7s"}) {
    const Site site;
    fs::remove(site.robot / name);
    CHECK(fault_of(site.robot) ==
          (site.robot / name).string() + ": cannot be read: No such file or directory");
    std::ofstream(site.robot / name) << "no key";
    CHECK(fault_of(site.robot).starts_with((site.robot / name).string() + ": must be a"));
    fs::resize_file(site.robot / name, 64 * 1024 + 1);
    CHECK(fault_of(site.robot) == (site.robot / name).string() + ": must have at most 64 KiB");
    fs::remove(site.robot / name);
    REQUIRE(::mkfifo((site.robot / name).c_str(), 0600) == 0);
    CHECK(fault_of(site.robot) == (site.robot / name).string() + ": must be a file");
  }
  const Site site;
  CHECK(fault_of(site.store / "nobody").starts_with((site.store / "nobody").string() + ": must be a folder"));
}

TEST_CASE(
    "keys that have expired, or that are not valid yet by this machine's clock, are refused with dates") {
  const Site site;
  const std::int64_t now_s = keys::unix_now_s();
  const std::string certificate = (site.robot / "certificate.pem").string();
  CHECK(fault_of(site.robot, now_s + 10 * kYearS - 60) == "no error");
  CHECK(fault_of(site.robot, now_s + 10 * kYearS + 60).starts_with(certificate + ": has expired on 20"));
  // A clock that was never set, 1970; one at the date of the system's image is accepted.
  CHECK(fault_of(site.robot, 3600) == certificate +
                                          ": is not valid before 2020-01-01 00:00:00 UTC, and this machine's "
                                          "clock says 1970-01-01 01:00:00 UTC");
  CHECK(fault_of(site.robot, 1'680'000'000) == "no error");
}

TEST_CASE("files of another machine or of other authorities are refused, each by its rule") {
  const Site other;
  const auto fault_with = [&](const char* name, const fs::path& from) {
    const Site site;
    fs::copy_file((from.empty() ? site.roof : from) / name, site.robot / name,
                  fs::copy_options::overwrite_existing);
    return fault_of(site.robot).substr(site.robot.string().size() + 1);
  };
  CHECK(fault_with("key.pem", {}) == "key.pem: must be the private key of certificate.pem beside it");
  CHECK(fault_with("permissions.p7s", {}) ==
        "permissions.p7s: must be those of certificate.pem beside it, CN=robot,O=isobar, but are those of "
        "CN=roof,O=isobar");
  CHECK(fault_with("identity_ca.pem", other.robot) ==
        "certificate.pem: must be signed by identity_ca.pem beside it, which is another authority");
  for (const char* name : {"governance.p7s", "permissions.p7s"}) {
    CHECK(fault_with(name, other.robot)
              .starts_with(std::string(name) + ": must be signed by permissions_ca.pem"));
  }
}

TEST_CASE("a changed document is refused: nobody gives himself rights") {
  const Site site;
  replace_in(site.robot / "permissions.p7s", "<subscribe>", "<publish>");
  CHECK(fault_of(site.robot).starts_with((site.robot / "permissions.p7s").string() + ": must be signed by"));
  replace_in(site.roof / "governance.p7s", "SIGN_WITH_ORIGIN_AUTHENTICATION", "NONE");
  CHECK(fault_of(site.roof).starts_with((site.roof / "governance.p7s").string() + ": must be signed by"));
}

TEST_CASE("a private key that other users can read is refused with the remedy") {
  const Site site;
  const fs::path key = site.robot / "key.pem";
  REQUIRE(::chmod(key.c_str(), 0644) == 0);
  CHECK(fault_of(site.robot) == key.string() + ": must be closed to other users: chmod 600 " + key.string());
  REQUIRE(::chmod(key.c_str(), 0640) == 0);
  CHECK(fault_of(site.robot) == "no error");
}

TEST_CASE("the fingerprint changes with any file, also when a file of equal size replaces it") {
  const Site site;
  const std::string before = keys::fingerprint(site.robot);
  CHECK(keys::fingerprint(site.robot) == before);
  fs::copy_file(site.robot / "key.pem", site.robot / "copy");
  fs::rename(site.robot / "copy", site.robot / "key.pem");
  const std::string replaced = keys::fingerprint(site.robot);
  CHECK(replaced != before);
  fs::remove(site.robot / "governance.p7s");
  CHECK(keys::fingerprint(site.robot) != replaced);
}

}  // namespace

}  // namespace isobar::test::test_key_folder
