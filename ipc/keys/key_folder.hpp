// SPDX-License-Identifier: BSD-3-Clause
// The keys of this machine: the folder dds.keys_directory, checked before DDS security uses it, so that the
// error names the file and the rule.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace isobar::keys {

/// A folder whose keys can be used.
struct KeyFolder {
  std::filesystem::path folder;
  std::string subject;             ///< of the certificate, "CN=roof,O=isobar"
  std::int64_t until_s = 0;        ///< end of validity, seconds since 1970 (UTC)
  std::vector<std::string> write;  ///< DDS topics that this machine may write, see Permissions
  std::vector<std::string> read;

  [[nodiscard]] bool is_station() const noexcept { return !write.empty(); }
  /// Base station whose topics this machine may write: "roof"; empty: none.
  [[nodiscard]] std::string station() const;
};

/// Checks that the six files are there, belong together, and are valid now, and that the certificate is not in
/// the list of revoked ones, if there is one.
/// @param now_s seconds since 1970 (UTC), see unix_now_s()
/// @throws DataError "path: rule" for the first rule that is broken
[[nodiscard]] KeyFolder check_key_folder(const std::filesystem::path& folder, std::int64_t now_s);

/// Checks that the permissions fit what the machine is to do.
/// @param writes, reads DDS topics, "rt/roof/fluid_pressure"
/// @throws DataError "path: rule" for the first topic that is not permitted
void check_permitted(const KeyFolder& keys, const std::vector<std::string>& writes,
                     const std::vector<std::string>& reads);

/// The system's clock: seconds since 1970 (UTC).
[[nodiscard]] std::int64_t unix_now_s();

/// Changes when a file of the folder is replaced, added or removed: times and sizes of the files.
[[nodiscard]] std::string fingerprint(const std::filesystem::path& folder);

}  // namespace isobar::keys
