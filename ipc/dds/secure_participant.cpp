// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/dds/secure_participant.hpp"

#include <dlfcn.h>

#include <array>
#include <system_error>

#include "core/errors.hpp"
#include "core/text_list.hpp"
#include "ipc/dds/qos.hpp"
#include "ipc/keys/key_files.hpp"
#include "ipc/keys/limits.hpp"

namespace isobar::dds {
namespace {

/// A plugin of DDS security: part of its properties' names, its library, its functions.
struct Plugin {
  const char* property;
  const char* library;
  const char* init;
  const char* finalize;
};
constexpr std::array kPlugins{
    Plugin{"auth", "libdds_security_auth.so", "init_authentication", "finalize_authentication"},
    Plugin{"access", "libdds_security_ac.so", "init_access_control", "finalize_access_control"},
    Plugin{"crypto", "libdds_security_crypto.so", "init_crypto", "finalize_crypto"},
};

/// A file of the keys and the property that names it.
struct KeyFile {
  const char* property;
  const char* name;
};
constexpr std::array kKeyFiles{
    KeyFile{"dds.sec.auth.identity_ca", keys::kIdentityAuthority},
    KeyFile{"dds.sec.auth.identity_certificate", keys::kCertificate},
    KeyFile{"dds.sec.auth.private_key", keys::kPrivateKey},
    KeyFile{"dds.sec.access.permissions_ca", keys::kPermissionsAuthority},
    KeyFile{"dds.sec.access.governance", keys::kGovernance},
    KeyFile{"dds.sec.access.permissions", keys::kPermissions},
};

/// Cyclone's own property: certificates that the authority has revoked.
constexpr const char* kRevocationsProperty = "org.eclipse.cyclonedds.sec.auth.crl";

/// Path of a plugin: in the private folder of Debian's package beside the library, or beside it. The
/// loader would find it by name in neither.
std::filesystem::path plugin_path(const char* name) {
  Dl_info info{};
  if (::dladdr(reinterpret_cast<void*>(&dds_create_domain), &info) == 0 || info.dli_fname == nullptr) {
    throw ServiceError("DDS security: the folder of Cyclone DDS is unknown");
  }
  const std::filesystem::path folder = std::filesystem::path(info.dli_fname).parent_path();
  for (const std::filesystem::path& path : {folder / "libddsc0debian" / name, folder / name}) {
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored)) return path;
  }
  throw ServiceError("DDS security: " + (folder / "libddsc0debian" / name).string() +
                     " is missing; it belongs to the package libddsc0debian");
}

QosPointer secure_qos(const std::filesystem::path& folder) {
  QosPointer qos = make_qos();
  for (const Plugin& plugin : kPlugins) {
    const std::string prefix = std::string("dds.sec.") + plugin.property + ".library.";
    dds_qset_prop(qos.get(), (prefix + "path").c_str(), plugin_path(plugin.library).c_str());
    dds_qset_prop(qos.get(), (prefix + "init").c_str(), plugin.init);
    dds_qset_prop(qos.get(), (prefix + "finalize").c_str(), plugin.finalize);
  }
  for (const KeyFile& file : kKeyFiles) {
    dds_qset_prop(qos.get(), file.property, ("file:" + (folder / file.name).string()).c_str());
  }
  const std::filesystem::path revocations = folder / keys::kRevocations;
  std::error_code error;
  if (std::filesystem::exists(revocations, error)) {
    dds_qset_prop(qos.get(), kRevocationsProperty, ("file:" + revocations.string()).c_str());
  }
  return qos;
}

}  // namespace

int secure_domain_number(int domain_id) { return (domain_id + 1) % (keys::kLastDomain + 1); }

std::string secure_domain_configuration(const ParticipantSettings& settings,
                                        const std::vector<Interface>& interfaces) {
  std::string xml = domain_configuration(settings, interfaces);
  const std::string open = "<Discovery>";
  const std::size_t place = xml.find(open);
  if (place == std::string::npos) throw ServiceError("DDS security: configuration without <Discovery>");
  xml.insert(place + open.size(),
             "<ExternalDomainId>" + std::to_string(settings.domain_id) + "</ExternalDomainId>");
  return xml;
}

SecureParticipant::SecureParticipant(const ParticipantSettings& settings, const std::filesystem::path& keys)
    : SecureParticipant(
          settings, choose_interfaces(interfaces_up(), split_list(settings.network_interface)).used, keys) {}

SecureParticipant::SecureParticipant(const ParticipantSettings& settings,
                                     const std::vector<Interface>& interfaces,
                                     const std::filesystem::path& keys) {
  const QosPointer qos = secure_qos(std::filesystem::absolute(keys));
  const auto number = static_cast<dds_domainid_t>(secure_domain_number(settings.domain_id));
  const std::string what = "domain " + std::to_string(settings.domain_id);
  domain_ = checked(dds_create_domain(number, secure_domain_configuration(settings, interfaces).c_str()),
                    "secure " + what + " cannot be created");
  participant_ = checked(dds_create_participant(number, qos.get(), nullptr),
                         "secure participant in " + what + " with the keys in " + keys.string());
}

}  // namespace isobar::dds
