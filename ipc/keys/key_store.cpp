// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/keys/key_store.hpp"

#include <algorithm>
#include <cctype>

#include "core/errors.hpp"
#include "ipc/keys/access.hpp"
#include "ipc/keys/certificate.hpp"
#include "ipc/keys/key_files.hpp"
#include "ipc/keys/key_folder.hpp"
#include "ipc/keys/signed_document.hpp"

namespace isobar::keys {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxNameLength = 64;

bool consists_of(const std::string& text, std::string_view also) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [also](unsigned char c) {
    return std::isalnum(c) != 0 || also.find(static_cast<char>(c)) != std::string_view::npos;
  });
}

void check(const Member& member) {
  if (!consists_of(member.name, "_-") || member.name.size() > kMaxNameLength || member.name == kAuthorities) {
    throw UsageError(member.name +
                     ": the name of a machine must be 1 to 64 letters, digits, '_' or '-', and not " +
                     kAuthorities);
  }
  const std::string& station = member.station;
  const bool is_robot = station.empty();
  if (!is_robot && (!consists_of(station, "_/") || station.front() == '/' || station.back() == '/' ||
                    station.size() > 100)) {
    throw UsageError(
        station +
        ": the name of a base station must be as dds.base_station, 1 to 100 letters, digits, '_' "
        "or '/', with no '/' at the ends");
  }
}

Identity read_authority(const fs::path& folder, const char* certificate, const char* key) {
  const fs::path certificate_file = folder / certificate;
  const fs::path key_file = folder / key;
  return {certificate_of(read_key_file(certificate_file), certificate_file.string()),
          private_key_of(read_key_file(key_file), key_file.string())};
}

StoreEntry entry_of(const fs::path& folder, std::int64_t now_s) {
  StoreEntry entry;
  entry.name = folder.filename().string();
  try {
    const KeyFolder keys = check_key_folder(folder, now_s);
    entry.use = keys.is_station() ? "base station " + keys.station() : "robot";
    entry.until_s = keys.until_s;
  } catch (const Error& error) {
    entry.use = "unusable";
    entry.fault = error.what();
  }
  return entry;
}

}  // namespace

void make_key_store(const fs::path& store, int years) {
  NewFolder folder(store.has_filename() ? store : store.parent_path());
  folder.make_folder(kAuthorities);
  const auto write = [&folder](const char* name, const std::string& text) {
    folder.write((std::string(kAuthorities) + "/" + name).c_str(), text);
  };
  // Two authorities, as DDS security intends: a certificate proves who somebody is, not what he may do.
  const Validity validity = valid_for(years);
  const Identity identity = make_authority("isobar identity authority", validity);
  const Identity permissions = make_authority("isobar permissions authority", validity);
  write(kIdentityAuthority, pem_of(*identity.certificate));
  write(kIdentityAuthorityKey, pem_of(*identity.key));
  write(kPermissionsAuthority, pem_of(*permissions.certificate));
  write(kPermissionsAuthorityKey, pem_of(*permissions.key));
  write(kGovernance, sign_document(governance_text(), permissions));
  folder.finish();
}

fs::path add_member(const fs::path& store, const Member& member, int years) {
  check(member);
  const fs::path authorities = store / kAuthorities;
  const Identity identity = read_authority(authorities, kIdentityAuthority, kIdentityAuthorityKey);
  const Identity permissions = read_authority(authorities, kPermissionsAuthority, kPermissionsAuthorityKey);
  Validity validity = valid_for(years);
  validity.until_s = std::min({validity.until_s, validity_of(*identity.certificate).until_s,
                               validity_of(*permissions.certificate).until_s});
  const Identity made = issue(identity, member.name, validity);
  const std::string subject = subject_of(*made.certificate);
  const Permissions granted = member.station.empty() ? robot_permissions(subject, validity)
                                                     : station_permissions(subject, member.station, validity);
  fs::path place = store / member.name;
  NewFolder folder(place);
  folder.write(kIdentityAuthority, pem_of(*identity.certificate));
  folder.write(kPermissionsAuthority, pem_of(*permissions.certificate));
  folder.write(kGovernance, read_key_file(authorities / kGovernance));
  folder.write(kCertificate, pem_of(*made.certificate));
  folder.write(kPrivateKey, pem_of(*made.key));
  folder.write(kPermissions, sign_document(permissions_text(member.name, granted), permissions));
  folder.finish();
  return place;
}

std::vector<StoreEntry> list_store(const fs::path& store) {
  const fs::path authority = store / kAuthorities / kIdentityAuthority;
  const CertificatePointer certificate = certificate_of(read_key_file(authority), authority.string());
  std::vector<StoreEntry> entries{{kAuthorities, "authorities", validity_of(*certificate).until_s, {}}};
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(store)) {
    if (entry.is_directory() && entry.path().filename() != kAuthorities) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  const std::int64_t now_s = unix_now_s();
  for (const fs::path& folder : folders) entries.push_back(entry_of(folder, now_s));
  return entries;
}

}  // namespace isobar::keys
