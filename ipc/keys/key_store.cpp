// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/keys/key_store.hpp"

#include <algorithm>
#include <cctype>
#include <system_error>

#include "core/errors.hpp"
#include "ipc/keys/access.hpp"
#include "ipc/keys/certificate.hpp"
#include "ipc/keys/key_files.hpp"
#include "ipc/keys/key_folder.hpp"
#include "ipc/keys/revocation.hpp"
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

/// The list of revoked certificates; null: none was revoked yet.
RevocationsPointer read_revocations(const fs::path& store, const X509& authority) {
  const fs::path file = store / kAuthorities / kRevocations;
  std::error_code error;
  if (fs::symlink_status(file, error).type() == fs::file_type::not_found) return nullptr;
  return revocations_of(read_key_file(file), authority, file.string());
}

CertificatePointer read_certificate_of(const fs::path& machine) {
  const fs::path file = machine / kCertificate;
  return certificate_of(read_key_file(file), file.string());
}

/// @throws DataError when the folder has no authorities
void require_store(const fs::path& store) {
  std::error_code error;
  if (fs::is_directory(store / kAuthorities, error)) return;
  throw DataError((store / kAuthorities).string() +
                  ": is missing; make a folder of keys by isobar keys init " + store.string());
}

/// Folders of the machines, by name.
std::vector<fs::path> machines_of(const fs::path& store) {
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(store)) {
    if (entry.is_directory() && entry.path().filename() != kAuthorities) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

StoreEntry entry_of(const fs::path& folder, const X509_CRL* revocations, std::int64_t now_s) {
  StoreEntry entry;
  entry.name = folder.filename().string();
  try {
    const CertificatePointer certificate = read_certificate_of(folder);
    if (revocations != nullptr && is_revoked(*revocations, *certificate)) {
      entry.use = "revoked";
      entry.until_s = validity_of(*certificate).until_s;
      return entry;
    }
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
  require_store(store);
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
  if (read_revocations(store, *identity.certificate)) {
    folder.write(kRevocations, read_key_file(authorities / kRevocations));
  }
  folder.finish();
  return place;
}

Revocation revoke_member(const fs::path& store, const std::string& name) {
  check({name, ""});
  require_store(store);
  const fs::path authorities = store / kAuthorities;
  const fs::path machine = store / name;
  const Identity identity = read_authority(authorities, kIdentityAuthority, kIdentityAuthorityKey);
  const CertificatePointer certificate = read_certificate_of(machine);
  const RevocationsPointer former = read_revocations(store, *identity.certificate);
  const std::string list = with_revoked(identity, former.get(), *certificate);
  Revocation done{authorities / kRevocations, machine.string() + ".revoked"};
  std::error_code error;
  for (int i = 2; fs::exists(fs::symlink_status(done.moved, error)); ++i) {
    done.moved = machine.string() + ".revoked-" + std::to_string(i);
  }
  replace_key_file(done.list, list);
  fs::rename(machine, done.moved, error);
  if (error) throw ServiceError(machine.string() + ": cannot be renamed: " + error.message());
  for (const fs::path& other : machines_of(store)) replace_key_file(other / kRevocations, list);
  return done;
}

std::vector<StoreEntry> list_store(const fs::path& store) {
  require_store(store);
  const fs::path authority = store / kAuthorities / kIdentityAuthority;
  const CertificatePointer certificate = certificate_of(read_key_file(authority), authority.string());
  std::vector<StoreEntry> entries{{kAuthorities, "authorities", validity_of(*certificate).until_s, {}}};
  const RevocationsPointer revocations = read_revocations(store, *certificate);
  const std::int64_t now_s = unix_now_s();
  for (const fs::path& folder : machines_of(store)) {
    entries.push_back(entry_of(folder, revocations.get(), now_s));
  }
  return entries;
}

}  // namespace isobar::keys
