// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "ipc/keys/key_folder.hpp"
#include "ipc/keys/key_store.hpp"
#include "tests/ipc/keys/key_folders.hpp"
#include "tests/support/message_of.hpp"

namespace isobar::test::test_key_store {

namespace {

namespace fs = std::filesystem;

unsigned mode_of(const fs::path& path) {
  struct stat status {};
  REQUIRE(::stat(path.c_str(), &status) == 0);
  return status.st_mode & 0777U;
}

std::string content_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST_CASE("a store has two authorities and a folder a machine, closed to everybody else") {
  const Site site;
  for (const auto& entry : fs::recursive_directory_iterator(site.store)) {
    CHECK_MESSAGE(mode_of(entry.path()) == (entry.is_directory() ? 0700U : 0600U), entry.path());
  }
  CHECK(mode_of(site.store) == 0700U);
  // The keys that can make keys never leave the store.
  for (const fs::path& machine : {site.robot, site.roof}) {
    CHECK(std::distance(fs::directory_iterator(machine), {}) == 6);
    CHECK_FALSE(fs::exists(machine / "identity_ca_key.pem"));
    CHECK_FALSE(fs::exists(machine / "permissions_ca_key.pem"));
  }
  CHECK(content_of(site.store / "authorities/identity_ca.pem") !=
        content_of(site.store / "authorities/permissions_ca.pem"));
}

TEST_CASE("keys are never overwritten, and what exists stays as it was") {
  const Site site;
  const std::string before = content_of(site.roof / "key.pem");
  const std::string authority = content_of(site.store / "authorities/identity_ca_key.pem");
  CHECK_THROWS_AS(keys::make_key_store(site.store, 20), ServiceError);
  CHECK(message_of([&] {
          keys::add_member(site.store, {"roof", "roof"}, 10);
        }) == site.roof.string() +
                  ": exists already; keys are never overwritten: choose another name, or move it away");
  CHECK(content_of(site.roof / "key.pem") == before);
  CHECK(content_of(site.store / "authorities/identity_ca_key.pem") == authority);
  // An empty folder is somebody's, too; and nothing half-made remains.
  fs::create_directory(site.store / "empty");
  CHECK_THROWS_AS(keys::add_member(site.store, {"empty", ""}, 10), ServiceError);
  CHECK(fs::is_empty(site.store / "empty"));
  for (const auto& entry : fs::directory_iterator(site.store)) {
    CHECK(entry.path().string().find(".new-") == std::string::npos);
  }
}

TEST_CASE(
    "names that would leave the store, hide in it or break a topic are refused before anything is made") {
  const Site site;
  for (const char* name : {"", ".", "..", "../robot2", "a/b", ".hidden", "a b", "authorities", "a\nb", "é"}) {
    CHECK_THROWS_AS(keys::add_member(site.store, {name, ""}, 10), UsageError);
  }
  CHECK_THROWS_AS(keys::add_member(site.store, {std::string(65, 'a'), ""}, 10), UsageError);
  for (const char* station : {"*", "roof*", "/roof", "roof/", "r?", "</topic>", "roof x"}) {
    CHECK_THROWS_AS(keys::add_member(site.store, {"other", station}, 10), UsageError);
  }
  CHECK_FALSE(fs::exists(site.store / "other"));
}

TEST_CASE("a store is listed by name with use and end of validity; a damaged folder is named with its rule") {
  const Site site;
  const std::int64_t now_s = keys::unix_now_s();
  fs::remove(site.robot / "permissions.p7s");
  const std::vector<keys::StoreEntry> entries = keys::list_store(site.store);
  REQUIRE(entries.size() == 3);
  constexpr std::int64_t kYearS = 31'557'600;
  CHECK(entries[0].use == "authorities");
  CHECK(std::abs(entries[0].until_s - now_s - 20 * kYearS) < 60);
  CHECK(entries[1].name == "robot");
  CHECK(entries[1].fault ==
        (site.robot / "permissions.p7s").string() + ": cannot be read: No such file or directory");
  CHECK(entries[2].name == "roof");
  CHECK(entries[2].use == "base station roof");
  CHECK(entries[2].fault.empty());
  CHECK(std::abs(entries[2].until_s - now_s - 10 * kYearS) < 60);
}

TEST_CASE("keys are not valid for longer than the authorities") {
  const TemporaryFolder folder;
  const fs::path store = folder.path() / "site";
  keys::make_key_store(store, 1);
  keys::add_member(store, {"robot", ""}, 10);
  CHECK(keys::list_store(store)[1].until_s == keys::list_store(store)[0].until_s);
}

TEST_CASE("without authorities nothing is made, and the error names the missing file") {
  const TemporaryFolder folder;
  CHECK(message_of([&] {
          keys::add_member(folder.path(), {"robot", ""}, 10);
        }) == (folder.path() / "authorities").string() +
                  ": is missing; make a folder of keys by isobar keys init " + folder.path().string());
  CHECK_THROWS_AS(static_cast<void>(keys::list_store(folder.path())), DataError);
}

TEST_CASE(
    "revoked keys are refused by every machine that has the list, and their name is free for new ones") {
  const Site site;
  const auto fault_of = [](const fs::path& folder) {
    return message_of([&] { static_cast<void>(keys::check_key_folder(folder, keys::unix_now_s())); });
  };
  const keys::Revocation done = keys::revoke_member(site.store, "roof");
  CHECK(done.list == site.store / "authorities/revoked.pem");
  CHECK(done.moved == site.store / "roof.revoked");
  CHECK(fault_of(done.moved) ==
        (done.moved / "certificate.pem").string() +
            ": is revoked by revoked.pem beside it: make new keys by isobar keys add");
  CHECK(fault_of(site.robot) == "no error");
  CHECK(content_of(site.robot / "revoked.pem") == content_of(done.list));
  CHECK(mode_of(done.list) == 0600U);
  // New keys of the same name, made and revoked: the list keeps both.
  keys::add_member(site.store, {"roof", "roof"}, 10);
  CHECK(fault_of(site.roof) == "no error");
  CHECK(content_of(site.roof / "revoked.pem") == content_of(done.list));
  CHECK(keys::revoke_member(site.store, "roof").moved == site.store / "roof.revoked-2");
  const std::vector<keys::StoreEntry> entries = keys::list_store(site.store);
  REQUIRE(entries.size() == 4);
  CHECK(entries[1].use == "robot");
  CHECK(entries[2].use == "revoked");
  CHECK(entries[3].use == "revoked");
  CHECK(entries[3].fault.empty());
  CHECK(message_of([&] { keys::revoke_member(site.store, "nobody"); }) ==
        (site.store / "nobody/certificate.pem").string() + ": cannot be read: No such file or directory");
}

TEST_CASE(
    "a list of revoked keys that was changed or comes from another authority is an error, not an empty one") {
  const Site site;
  const Site other;
  static_cast<void>(keys::revoke_member(other.store, "roof"));
  const fs::path list = site.robot / "revoked.pem";
  const auto fault = [&] {
    return message_of([&] { static_cast<void>(keys::check_key_folder(site.robot, keys::unix_now_s())); });
  };
  fs::copy_file(other.store / "authorities/revoked.pem", list);
  CHECK(fault() == list.string() +
                       ": must be signed by identity_ca.pem; it was changed or comes from another authority");
  std::ofstream(list) << "";
  CHECK(fault().starts_with(list.string() + ": must be a list of revoked certificates (X.509 CRL) in PEM"));
  fs::remove(list);
  fs::create_symlink("nowhere", list);
  CHECK(fault().starts_with(list.string() + ": cannot be read"));
}

}  // namespace

}  // namespace isobar::test::test_key_store
