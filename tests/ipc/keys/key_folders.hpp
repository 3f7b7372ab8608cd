// SPDX-License-Identifier: BSD-3-Clause
// Folders with keys for tests.
#pragma once

#include <filesystem>
#include <string>

#include "ipc/keys/key_store.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test {

/// A store with the keys of a robot and of the base station "roof", in a folder of its own.
struct Site {
  TemporaryFolder folder;
  std::filesystem::path store = folder.path() / "site";
  std::filesystem::path robot = store / "robot";
  std::filesystem::path roof = store / "roof";

  Site() {
    keys::make_key_store(store, 20);
    keys::add_member(store, {"robot", ""}, 10);
    keys::add_member(store, {"roof", "roof"}, 10);
  }
};

}  // namespace isobar::test
