// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/keys/key_folder.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <system_error>

#include "core/errors.hpp"
#include "ipc/keys/access.hpp"
#include "ipc/keys/certificate.hpp"
#include "ipc/keys/key_files.hpp"
#include "ipc/keys/revocation.hpp"
#include "ipc/keys/signed_document.hpp"

namespace isobar::keys {
namespace {

namespace fs = std::filesystem;

constexpr std::array kFiles{kIdentityAuthority, kPermissionsAuthority, kGovernance, kCertificate,
                            kPrivateKey,        kPermissions,          kRevocations};

void check_mode(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) == 0 && (status.st_mode & S_IRWXO) != 0) {
    throw DataError(file.string() + ": must be closed to other users: chmod 600 " + file.string());
  }
}

CertificatePointer read_certificate(const fs::path& file) {
  return certificate_of(read_key_file(file), file.string());
}

void check_revocations(const fs::path& folder, const X509& certificate, const X509& authority) {
  const fs::path file = folder / kRevocations;
  std::error_code error;
  if (fs::symlink_status(file, error).type() == fs::file_type::not_found) return;
  if (is_revoked(*revocations_of(read_key_file(file), authority, file.string()), certificate)) {
    throw DataError((folder / kCertificate).string() +
                    ": is revoked by revoked.pem beside it: make new keys by isobar keys add");
  }
}

/// @return end of validity
std::int64_t check_identity(const fs::path& folder, const X509& certificate, std::int64_t now_s) {
  const CertificatePointer authority = read_certificate(folder / kIdentityAuthority);
  const fs::path key_file = folder / kPrivateKey;
  const KeyPointer key = private_key_of(read_key_file(key_file), key_file.string());
  check_mode(key_file);
  if (X509_check_private_key(const_cast<X509*>(&certificate), key.get()) != 1) {
    throw DataError(key_file.string() + ": must be the private key of certificate.pem beside it");
  }
  if (const std::string rule = broken_rule(certificate, *authority, now_s); !rule.empty()) {
    throw DataError((folder / kCertificate).string() + ": " + rule);
  }
  check_revocations(folder, certificate, *authority);
  return std::min(validity_of(certificate).until_s, validity_of(*authority).until_s);
}

Permissions check_documents(const fs::path& folder, const std::string& subject, std::int64_t now_s) {
  const fs::path authority_file = folder / kPermissionsAuthority;
  const CertificatePointer authority = read_certificate(authority_file);
  const auto verified = [&](const fs::path& file) {
    return verified_text(read_key_file(file), *authority, file.string(), authority_file.filename().string());
  };
  static_cast<void>(verified(folder / kGovernance));
  const fs::path file = folder / kPermissions;
  Permissions permissions = parse_permissions(verified(file), file.string());
  if (permissions.subject != subject) {
    throw DataError(file.string() + ": must be those of certificate.pem beside it, " + subject +
                    ", but are those of " + permissions.subject);
  }
  Validity& validity = permissions.validity;
  validity.until_s = std::min(validity.until_s, validity_of(*authority).until_s);
  if (now_s > validity.until_s) {
    throw DataError(file.string() + ": has expired on " + date_of(validity.until_s));
  }
  if (now_s < validity.from_s) {
    throw DataError(file.string() + ": is not valid before " + date_of(validity.from_s) +
                    ", and this machine's clock says " + date_of(now_s));
  }
  return permissions;
}

}  // namespace

std::string KeyFolder::station() const {
  constexpr std::string_view kPrefix = "rt/";
  constexpr std::string_view kSuffix = "/*";
  for (const std::string& topic : write) {
    if (topic.size() > kPrefix.size() + kSuffix.size() && topic.starts_with(kPrefix) &&
        topic.ends_with(kSuffix)) {
      return topic.substr(kPrefix.size(), topic.size() - kPrefix.size() - kSuffix.size());
    }
  }
  return {};
}

KeyFolder check_key_folder(const fs::path& folder, std::int64_t now_s) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw DataError(folder.string() + ": must be a folder with the keys of this machine" +
                    (error ? ": " + error.message() : std::string()));
  }
  const CertificatePointer certificate = read_certificate(folder / kCertificate);
  KeyFolder keys;
  keys.folder = folder;
  keys.subject = subject_of(*certificate);
  keys.until_s = check_identity(folder, *certificate, now_s);
  Permissions permissions = check_documents(folder, keys.subject, now_s);
  keys.until_s = std::min(keys.until_s, permissions.validity.until_s);
  keys.write = std::move(permissions.write);
  keys.read = std::move(permissions.read);
  return keys;
}

void check_permitted(const KeyFolder& keys, const std::vector<std::string>& writes,
                     const std::vector<std::string>& reads) {
  const std::string file = (keys.folder / kPermissions).string();
  for (const std::string& topic : writes) {
    if (covers(keys.write, topic)) continue;
    std::string rule = file + ": must permit to write ";
    rule += topic + ": make keys by isobar keys add DIR NAME --base-station STATION";
    throw DataError(rule);
  }
  for (const std::string& topic : reads) {
    if (covers(keys.read, topic)) continue;
    std::string rule = file + ": must permit to read ";
    rule += topic + ": make keys by isobar keys add DIR NAME";
    throw DataError(rule);
  }
}

std::int64_t unix_now_s() {
  return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::string fingerprint(const fs::path& folder) {
  std::string text;
  for (const char* name : kFiles) {
    struct stat status {};
    if (::stat((folder / name).c_str(), &status) != 0) {
      text += "-;";
      continue;
    }
    text += std::to_string(status.st_ino) + "," + std::to_string(status.st_size) + "," +
            std::to_string(status.st_ctim.tv_sec) + "." + std::to_string(status.st_ctim.tv_nsec) + ";";
  }
  return text;
}

}  // namespace isobar::keys
