// SPDX-License-Identifier: BSD-3-Clause
// Names of the files with keys, and small files that are never overwritten.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace isobar::keys {

/// Files of one machine, in its folder: dds.keys_directory.
inline constexpr const char* kIdentityAuthority = "identity_ca.pem";
inline constexpr const char* kPermissionsAuthority = "permissions_ca.pem";
inline constexpr const char* kGovernance = "governance.p7s";
inline constexpr const char* kCertificate = "certificate.pem";
inline constexpr const char* kPrivateKey = "key.pem";
inline constexpr const char* kPermissions = "permissions.p7s";
/// Only when a certificate was revoked.
inline constexpr const char* kRevocations = "revoked.pem";

/// Folder of the authorities, beside those of the machines, and their private keys in it.
inline constexpr const char* kAuthorities = "authorities";
inline constexpr const char* kIdentityAuthorityKey = "identity_ca_key.pem";
inline constexpr const char* kPermissionsAuthorityKey = "permissions_ca_key.pem";

/// The content of a file of at most 64 KiB.
/// @throws DataError "path: rule" when it is missing, cannot be read, or is larger
[[nodiscard]] std::string read_key_file(const std::filesystem::path& file);

/// Writes a file in place of its older version, mode 0600: at each moment one of the two is there, whole.
/// @throws ServiceError naming the path
void replace_key_file(const std::filesystem::path& file, std::string_view text);

/// A folder under construction beside its final place, so that a folder with half of its files never has the
/// final name. Removed unless finish() was called.
class NewFolder {
 public:
  /// @throws ServiceError naming the path when it exists or cannot be made
  explicit NewFolder(std::filesystem::path final_place);
  ~NewFolder();
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  /// Writes a new file with mode 0600.
  /// @throws ServiceError naming the path
  void write(const char* name, std::string_view text) const;
  /// Makes a folder with mode 0700 in it.
  void make_folder(const char* name) const;
  /// Gives the folder its final name.
  /// @throws ServiceError naming the path, also when it has come into being meanwhile
  void finish();

 private:
  std::filesystem::path final_place_;
  std::filesystem::path place_;
};

}  // namespace isobar::keys
