// SPDX-License-Identifier: BSD-3-Clause
// The owner's folder of all keys: DIR/authorities and DIR/NAME for each machine.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace isobar::keys {

/// Makes the authorities and the rules of the secure domain in a new folder.
/// @param years validity of the authorities, 1 … 50
/// @throws ServiceError naming the path when the folder exists or cannot be made
void make_key_store(const std::filesystem::path& store, int years);

/// Whom a key is for.
struct Member {
  std::string name;     ///< of the machine and of its folder: letters, digits, '_' and '-', at most 64
  std::string station;  ///< base station whose pressure it writes; empty: a robot, which reads
};

/// Makes key, certificate and permissions of one machine, in a new folder of the store.
/// @param years validity, 1 … 50; at most that of the authorities
/// @return the folder, to be copied to the machine as its dds.keys_directory
/// @throws UsageError when the name or the station breaks its rule
/// @throws DataError "path: rule" when the store's files are missing or unusable
/// @throws ServiceError naming the path when the folder exists or cannot be made
std::filesystem::path add_member(const std::filesystem::path& store, const Member& member, int years);

/// What revoke_member() made.
struct Revocation {
  std::filesystem::path list;   ///< all revoked certificates, to be copied to every machine
  std::filesystem::path moved;  ///< the machine's folder, under its new name
};

/// Revokes the keys of one machine: its certificate is added to the list of revoked ones, in the store and in
/// the folders of the other machines, and its folder gets another name, so that its name is free.
/// @throws DataError "path: rule" when the store's or the machine's files are missing or unusable
/// @throws ServiceError naming the path when a file cannot be written
Revocation revoke_member(const std::filesystem::path& store, const std::string& name);

/// One line of the list of a store.
struct StoreEntry {
  std::string name;
  std::string use;           ///< "robot", "base station roof", "authorities", "revoked"
  std::int64_t until_s = 0;  ///< end of validity, seconds since 1970 (UTC)
  std::string fault;         ///< why it cannot be used: "path: rule"; empty: it can
};

/// The authorities and all machines, by name.
/// @throws DataError "path: rule" when this is no store
[[nodiscard]] std::vector<StoreEntry> list_store(const std::filesystem::path& store);

}  // namespace isobar::keys
