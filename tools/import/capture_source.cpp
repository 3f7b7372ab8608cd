// SPDX-License-Identifier: BSD-3-Clause
#include "tools/import/capture_source.hpp"

#include <system_error>
#include <vector>

#include "core/errors.hpp"
#include "core/printable_text.hpp"
#include "core/stamp.hpp"
#include "run/recording/pcap_packets.hpp"
#include "run/text/gzip_file.hpp"
#include "run/text/number_text.hpp"
#include "run/text/small_file.hpp"
#include "tools/import/model_votes.hpp"

namespace isobar::tools {
namespace {

/// Packets of one UDP port.
struct PortFindings {
  std::uint16_t port = 0;
  std::uint64_t packets = 0;
  std::string model;
  std::string mismatch;
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
};

PortFindings look_at(const std::filesystem::path& file, std::uint16_t port, const std::string& calibration,
                     const std::function<void(double)>& progress) {
  PortFindings found;
  found.port = port;
  ModelVotes votes;
  std::vector<std::unique_ptr<LidarDecoder>> ousters;
  for (const char* model : {"OS0", "OS1", "OS2"}) {
    if (calibration.empty()) break;
    try {
      LidarConfig config;
      config.model = model;
      config.calibration_file = calibration;
      ousters.push_back(make_lidar_decoder(config));
    } catch (const ConfigError&) {
      continue;  // metadata of another model
    }
  }
  recording::PcapPackets packets(file, {port, 0}, {});
  recording::StampedPacket packet;
  while (packets.next(packet)) {
    if (found.packets++ == 0) found.first_ns = packet.stamp_ns;
    found.last_ns = packet.stamp_ns;
    if (found.packets % 4096 == 0) progress(0.5);
    votes.add(packet.payload);
    for (const auto& ouster : ousters) {
      if (ouster->is_data(packet.payload)) found.model = std::string(ouster->model());
    }
  }
  if (found.model.empty()) found.model = votes.model();
  found.mismatch = votes.mismatch();
  return found;
}

/// --calibration, or an Ouster's metadata beside the capture with its name.
std::string calibration_of(const ImportRequest& request) {
  if (!request.calibration_file.empty()) return request.calibration_file;
  std::filesystem::path beside = request.source;
  beside.replace_extension(".json");
  std::error_code error;
  return std::filesystem::is_regular_file(beside, error) ? beside.string() : std::string();
}

std::vector<PortFindings> look_at_all(const ImportRequest& request, const std::string& calibration,
                                      std::vector<std::string>& notes,
                                      const std::function<void(double)>& progress) {
  // Packets for no port: the ports are counted.
  recording::PcapPackets packets(request.source, {0, 0}, {});
  recording::StampedPacket packet;
  while (packets.next(packet)) continue;
  progress(0.5);
  const recording::PortsSeen& seen = packets.extractor().other_ports();
  if (seen.empty()) {
    std::string why = "holds no UDP packets";
    for (const recording::Tally* tally : {&packets.tallies().file_truncated, &packets.tallies().other_link,
                                          &packets.tallies().malformed, &packets.tallies().other_protocol}) {
      if (tally->count > 0) why += "; " + tally->first_message;
    }
    throw DataError(request.source.string() + ": " + why);
  }
  if (packets.tallies().file_truncated.count > 0) {
    notes.push_back("damaged: " + packets.tallies().file_truncated.first_message);
  }
  std::vector<PortFindings> ports;
  for (unsigned port = 1; port <= 65'535; ++port) {
    if (seen.count(static_cast<std::uint16_t>(port)) == 0) continue;
    ports.push_back(look_at(request.source, static_cast<std::uint16_t>(port), calibration, progress));
  }
  return ports;
}

const PortFindings& choose_port(const ImportRequest& request, const std::vector<PortFindings>& ports) {
  const PortFindings* chosen = nullptr;
  std::string lidars;
  std::string all;
  for (const PortFindings& port : ports) {
    const std::string number = std::to_string(port.port);
    all += (all.empty() ? "" : ", ") + number + (port.mismatch.empty() ? "" : " (" + port.mismatch + ")");
    if (request.lidar == number) return port;
    if (port.model.empty()) continue;
    lidars += (lidars.empty() ? "" : ", ") + number + " (" + port.model + ")";
    if (chosen != nullptr && request.lidar.empty()) {
      lidars.append("; say --lidar ").append(number);
      throw UsageError("--lidar: there are several lidars, on UDP ports " + lidars);
    }
    chosen = &port;
  }
  if (!request.lidar.empty())
    throw UsageError("--lidar: no packets for port " + printable(request.lidar) + "; there are " + all);
  if (chosen == nullptr) {
    throw UsageError("--model: no packets of a lidar that a driver knows, on UDP ports " + all +
                     "; say --lidar PORT --model NAME (" + lidar_model_list() +
                     "), with --calibration FILE.json for an Ouster");
  }
  return *chosen;
}

}  // namespace

bool is_capture(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return false;
  const text::GzipFile bytes(file);
  const std::string_view head = bytes.head();
  for (const std::string_view magic :
       {std::string_view("\xd4\xc3\xb2\xa1", 4), std::string_view("\xa1\xb2\xc3\xd4", 4),
        std::string_view("\x4d\x3c\xb2\xa1", 4), std::string_view("\xa1\xb2\x3c\x4d", 4),
        std::string_view("\x0a\x0d\x0d\x0a", 4)}) {
    if (head == magic) return true;
  }
  return false;
}

CaptureFindings find_lidar(const ImportRequest& request, ImportReport& report,
                           const std::function<void(double)>& progress) {
  report.container = "capture";
  const std::string calibration = calibration_of(request);
  const std::vector<PortFindings> ports = look_at_all(request, calibration, report.notes, progress);
  const PortFindings& chosen = choose_port(request, ports);
  const std::string name = request.model.empty() ? chosen.model : request.model;
  const LidarModel* model = find_lidar_model(name);
  if (model == nullptr)
    throw UsageError("--model: \"" + printable(name) + "\" has no driver; there are " + lidar_model_list());
  if (model->needs_calibration && calibration.empty()) {
    throw UsageError("--calibration: the packets of an " + name +
                     " need the sensor's metadata: say --calibration FILE.json");
  }
  if (!chosen.mismatch.empty() && request.model.empty()) {
    report.notes.push_back("lidar: " + chosen.mismatch + ", and is taken; --model says otherwise");
  }
  CaptureFindings findings;
  findings.lidar.model = name;
  findings.lidar.port = chosen.port;
  findings.first_ns = chosen.first_ns;
  findings.last_ns = chosen.last_ns;
  if (model->needs_calibration || !request.calibration_file.empty()) {
    findings.calibration = calibration;
    findings.lidar.calibration_file = model->needs_calibration ? "os.json" : "calibration.csv";
  }
  for (const PortFindings& port : ports) {
    const bool is_info = port.port == model->info_port && port.port != chosen.port;
    if (is_info && request.imu != kNoTopic) findings.lidar.info_port = port.port;
    const double span_s = seconds_between(port.first_ns, port.last_ns);
    report.rows.push_back({"UDP port " + std::to_string(port.port), port.model, port.packets,
                           span_s > 0.0 ? static_cast<double>(port.packets - 1) / span_s : 0.0,
                           &port == &chosen ? "lidar.pcap: packets of " + name
                           : is_info        ? "lidar.pcap: the lidar's other packets"
                                            : "nothing"});
  }
  return findings;
}

void place_capture(const ImportRequest& request, const CaptureFindings& findings,
                   const std::filesystem::path& folder) {
  const auto place = [&](const std::filesystem::path& from, const std::string& name) {
    std::error_code error;
    if (request.link_files) {
      std::filesystem::create_symlink(std::filesystem::absolute(from), folder / name, error);
    } else {
      std::filesystem::copy_file(from, folder / name, std::filesystem::copy_options::overwrite_existing,
                                 error);
    }
    // The library says no more of a full disk than that writing failed.
    std::error_code ignored;
    const bool is_full = error && std::filesystem::space(folder, ignored).available <
                                      std::filesystem::file_size(from, ignored);
    if (error) {
      throw DataError((folder / name).string() +
                      ": cannot be written: " + (is_full ? "no space left on the disk" : error.message()));
    }
  };
  place(request.source, findings.lidar.file);
  if (!findings.calibration.empty()) place(findings.calibration, findings.lidar.calibration_file);
}

}  // namespace isobar::tools
