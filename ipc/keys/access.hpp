// SPDX-License-Identifier: BSD-3-Clause
// Documents of DDS security, in XML: who may write and read the topics of base stations.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ipc/keys/certificate.hpp"

namespace isobar::keys {

/// Rules of the secure DDS domain, for all machines: only members, every message signed for each receiver.
///
/// Origin authentication gives each reader a key of its own. So neither another member can sign in a base
/// station's name, nor does a datagram that was recorded on its way to one reader fit a later one.
[[nodiscard]] std::string governance_text();

/// What one machine may do.
struct Permissions {
  std::string subject;             ///< of its certificate
  std::vector<std::string> write;  ///< DDS topics, with * and ? as in file names
  std::vector<std::string> read;
  Validity validity;
};

/// Reads every topic of the secure domain: those of the base stations.
[[nodiscard]] Permissions robot_permissions(const std::string& subject, const Validity& validity);
/// Writes the topics of one base station, those below its name.
/// @param station its name, as dds.base_station: letters, digits, '_' and '/'
[[nodiscard]] Permissions station_permissions(const std::string& subject, const std::string& station,
                                              const Validity& validity);

/// The document.
/// @param name of the machine
[[nodiscard]] std::string permissions_text(const std::string& name, const Permissions& permissions);

/// Reads what permissions_text() wrote. Of another document: what it has in the same form.
/// @param path for the error's text
/// @throws DataError "path: rule" when subject or validity are missing
[[nodiscard]] Permissions parse_permissions(const std::string& text, const std::string& path);

/// Whether one of the expressions matches the topic.
[[nodiscard]] bool covers(const std::vector<std::string>& expressions, const std::string& topic);

}  // namespace isobar::keys
