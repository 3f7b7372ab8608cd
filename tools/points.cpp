// SPDX-License-Identifier: BSD-3-Clause
// `isobar points`: the points of a lidar's packets in a capture, without a recording, for looking at a sensor and
// for comparing decoders.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/errors.hpp"
#include "core/printable_text.hpp"
#include "daemon/silent_lidar.hpp"
#include "drivers/lidar/scan_assembler.hpp"
#include "drivers/lidar_models/lidar_models.hpp"
#include "run/files/ply_writer.hpp"
#include "run/files/text_file.hpp"
#include "run/recording/pcap_packets.hpp"
#include "tools/commands.hpp"
#include "tools/number_option.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {
namespace {

struct PointsOptions {
  std::filesystem::path capture;
  std::string model = "VLP-16";
  std::uint16_t port = 0;
  std::uint16_t info_port = 0;
  std::string calibration_file;
  double min_range_m = 0.0;
  double max_range_m = 300.0;
  std::filesystem::path out;
};

/// Writes scans: CSV, a line a point, or PLY.
class PointsFile {
 public:
  explicit PointsFile(const std::filesystem::path& file) {
    if (file.empty()) return;
    if (file.extension() == ".csv") {
      csv_.emplace(file);
      csv_->write("scan,t_ns,x_m,y_m,z_m,ring,intensity\n");
    } else if (file.extension() == ".ply") {
      ply_.emplace(file);
    } else {
      throw UsageError("--out: must end in .csv or .ply (got " + printable(file.string()) + ")");
    }
  }

  void add(const Scan& scan) {
    std::array<char, 160> line{};
    for (std::uint32_t i = 0; i < scan.point_count; ++i) {
      const ScanPoint& p = scan.points[i];
      if (ply_) ply_->add(p.x_m, p.y_m, p.z_m, p.intensity);
      if (!csv_) continue;
      const std::int64_t time_ns = scan.stamp_ns + p.time_4us * kPointTimeUnitNs;
      const int length =
          std::snprintf(line.data(), line.size(), "%u,%" PRId64 ",%.6f,%.6f,%.6f,%u,%u\n", scan.sequence,
                        time_ns, static_cast<double>(p.x_m), static_cast<double>(p.y_m),
                        static_cast<double>(p.z_m), unsigned{p.ring}, unsigned{p.intensity});
      csv_->write(line.data(), static_cast<std::size_t>(length));
    }
  }

  void close() {
    if (csv_) csv_->close();
    if (ply_) ply_->close();
  }

 private:
  std::optional<files::OutputFile> csv_;
  std::optional<files::PlyWriter> ply_;
};

void print_count(const char* what, std::uint64_t count) {
  if (count > 0) std::printf("  %-24s %llu\n", what, static_cast<unsigned long long>(count));
}

void print(const ScanAssembler& assembler, const recording::PcapPackets::Tallies& tallies) {
  const LidarCounters& counters = assembler.counters();
  std::printf("%s: %llu packets, %llu scans, %llu points\n", std::string(assembler.decoder().model()).c_str(),
              static_cast<unsigned long long>(counters.packets),
              static_cast<unsigned long long>(counters.scans),
              static_cast<unsigned long long>(counters.returns));
  print_count("without points", counters.no_points);
  print_count("lost", counters.lost);
  print_count("duplicated", counters.duplicated);
  print_count("reordered", counters.reordered);
  print_count("too late", counters.too_late);
  print_count("truncated", counters.truncated);
  print_count("oversized", counters.oversized);
  print_count("garbage", counters.garbage);
  print_count("of another model", counters.wrong_model);
  print_count("for another port", tallies.other_port.count);
  print_count("cut by the capture", tallies.cut.count);
  std::printf("  clock: %s\n", kLidarSyncTexts.name(assembler.decoder().sync()).data());
  if (const char* text = assembler.decoder().contradiction(); text != nullptr) std::printf("  %s\n", text);
  if (counters.wrong_model > 0) std::printf("  %s\n", assembler.decoder().mismatch().c_str());
}

/// What the capture holds instead of data packets, and why it ends early.
std::string found_text(const recording::PcapPackets& packets, const LidarModel& model,
                       const ScanAssembler& assembler, std::uint16_t info_port) {
  if (assembler.counters().wrong_model > 0) return assembler.decoder().mismatch();
  if (has_data_packets(assembler.counters())) return {};
  // The information packets were counted by read_information().
  std::string only = only_information_text(model, info_port, packets.extractor().other_ports(),
                                           assembler.counters().no_points);
  if (!only.empty()) return only;
  const recording::PcapPackets::Tallies& tallies = packets.tallies();
  for (const recording::Tally* tally :
       {&tallies.file_truncated, &tallies.other_link, &tallies.malformed, &tallies.other_protocol}) {
    if (tally->count > 0 && tallies.other_port.count == 0) return tally->first_message;
  }
  return packets.ports_text("the model's port or --port");
}

/// The packets of device information come first: the angles in them are the sensor's for as long as it lives.
void read_information(const std::filesystem::path& capture, std::uint16_t port, ScanAssembler& assembler) {
  if (port == 0) return;
  recording::PcapPackets packets(capture, {port, 0}, {});
  const auto unused = std::make_unique<Scan>();
  recording::StampedPacket packet;
  while (packets.next(packet)) {
    if (!assembler.decoder().is_data(packet.payload)) {
      (void)assembler.add_packet(packet.payload, packet.stamp_ns, *unused);
    }
  }
}

void points(const PointsOptions& options) {
  const LidarModel* model = find_lidar_model(options.model);
  if (model == nullptr) {
    throw UsageError("--model: must be one of " + lidar_model_list() + " (got " + printable(options.model) +
                     ")");
  }
  LidarConfig config;
  config.model = options.model;
  config.calibration_file = options.calibration_file;
  config.limits.min_range_m = options.min_range_m;
  config.limits.max_range_m = options.max_range_m;
  ScanAssembler assembler(make_lidar_decoder(config));
  PointsFile file(options.out);
  const std::uint16_t port = options.port != 0 ? options.port : model->port;
  const std::uint16_t info_port = options.info_port != 0 ? options.info_port : model->info_port;
  if (info_port != port) read_information(options.capture, info_port, assembler);

  recording::PcapPackets packets(options.capture, {port, 0}, {});
  const auto scan = std::make_unique<Scan>();
  recording::StampedPacket packet;
  while (packets.next(packet)) {
    if (assembler.add_packet(packet.payload, packet.stamp_ns, *scan).scan_complete) file.add(*scan);
  }
  if (assembler.flush(*scan)) file.add(*scan);
  file.close();
  print(assembler, packets.tallies());
  if (packets.tallies().file_truncated.count > 0) {
    std::printf("  %s\n", packets.tallies().file_truncated.first_message.c_str());
  }
  if (assembler.counters().packets == 0) {
    const std::string found = found_text(packets, *model, assembler, info_port);
    throw DataError(printable(options.capture.string()) + ": holds no data packet of a " + options.model +
                    " for UDP port " + std::to_string(port) + (found.empty() ? "" : ": " + found));
  }
}

}  // namespace

void add_points_command(CLI::App& app) {
  const auto [command, options] = add_subcommand<PointsOptions>(
      app, "points", "Decode the lidar packets of a capture: counts, and points as CSV or PLY", points);
  command.add_option("CAPTURE", options.capture, "pcap or pcapng file, compressed with gzip or not")
      ->required();
  command.add_option("--model", options.model, "model of the lidar: " + lidar_model_list())
      ->capture_default_str();
  command.add_option("--port", options.port, "UDP port of the data packets (default: the model's)")
      ->check(number_within(1, 65'535));
  command
      .add_option("--info-port", options.info_port,
                  "UDP port of position, device information and IMU packets (default: the model's)")
      ->check(number_within(1, 65'535));
  command.add_option("--calibration", options.calibration_file,
                     "calibration of this sensor: see lidar.calibration_file");
  command.add_option("--min-range", options.min_range_m, "drop nearer returns [m]")->capture_default_str();
  command.add_option("--max-range", options.max_range_m, "drop farther returns [m]")->capture_default_str();
  command.add_option("--out", options.out,
                     "FILE.csv: scan, time, position, ring, intensity; FILE.ply: a cloud");
}

}  // namespace isobar::tools
