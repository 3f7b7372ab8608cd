// SPDX-License-Identifier: BSD-3-Clause
// `isobar play`: sends a recording in real time: lidar packets to the lidar ports, all other samples as
// datagrams (drivers/datagram/datagram.hpp) to the input port.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "core/errors.hpp"
#include "core/stamp.hpp"
#include "daemon/lidar_clock.hpp"
#include "daemon/lidar_sender.hpp"
#include "drivers/datagram/datagram.hpp"
#include "drivers/lidar_models/lidar_models.hpp"
#include "run/files/text_file.hpp"
#include "run/recording/recording_reader.hpp"
#include "run/recording/reference.hpp"
#include "run/text/segments.hpp"
#include "tools/commands.hpp"
#include "tools/number_option.hpp"
#include "tools/player.hpp"
#include "tools/progress.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

struct PlayOptions {
  std::filesystem::path recording;
  std::string address = "127.0.0.1";
  std::uint16_t lidar_port = 0;  ///< 0: the recording's
  std::uint16_t info_port = 0;   ///< 0: the recording's
  std::uint16_t input_port = datagram::kDefaultPort;
  std::filesystem::path reference_out;
  double start_s = 0.0;
  std::optional<double> for_s;
  bool loop = false;
};

/// Writes reference and segments with stamps of the robot clock, for the evaluation of the live run.
void write_shifted_reference(const PlayOptions& options, const recording::Manifest& manifest,
                             std::int64_t shift_ns) {
  if (!manifest.reference) throw DataError(options.recording.string() + ": has no reference to shift");
  std::filesystem::create_directories(options.reference_out);
  auto poses = recording::read_tum(options.recording / manifest.reference->file);
  for (auto& pose : poses) pose.stamp_ns += shift_ns;
  recording::write_tum(options.reference_out / "reference.tum", poses);
  const auto segments_file = options.recording / recording::kSegmentsFile;
  if (!std::filesystem::exists(segments_file)) return;
  const auto segments = text::read_segments(text::TextLines(segments_file));
  files::OutputFile file(options.reference_out / recording::kSegmentsFile);
  file.write("t_start_ns,t_end_ns,label\n");
  for (const auto& segment : segments) {
    file.write(std::to_string(segment.start_ns + shift_ns) + "," + std::to_string(segment.end_ns + shift_ns) +
               "," + segment.label + "\n");
  }
  file.close();
}

LidarPlan lidar_plan(const PlayOptions& options, const recording::LidarEntry& lidar) {
  LidarPlan plan{.port = lidar.port, .info_port = lidar.info_port, .recorded_info_port = lidar.info_port};
  if (options.lidar_port != 0) plan.port = options.lidar_port;
  if (options.info_port != 0 && lidar.info_port != 0) plan.info_port = options.info_port;
  return plan;
}

LidarConfig lidar_of(const recording::LidarEntry& entry) {
  LidarConfig lidar;
  lidar.model = entry.model;
  lidar.calibration_file = entry.calibration_file;
  return lidar;
}

/// Reads up to the first event of the part that is played.
/// @throws DataError when the recording ends before it
void move_to_start(recording::RecordingReader& reader, const PlayOptions& options, recording::Event& event) {
  if (!reader.next(event)) throw DataError(options.recording.string() + ": holds no samples");
  const std::int64_t first_ns = event.stamp_ns;
  while (seconds_between(first_ns, event.stamp_ns) < options.start_s) {
    if (reader.next(event)) continue;
    throw UsageError("--start: " + options.recording.string() + " ends before this time");
  }
}

/// Plays the part once; a loop begins with it anew.
void play_once(const PlayOptions& options, Player& player) {
  recording::RecordingReader reader(options.recording);
  const LidarConfig lidar = lidar_of(*reader.manifest().lidar);
  reader.use_lidar_clock(lidar_clock(lidar));
  recording::Event event;
  move_to_start(reader, options, event);
  const std::int64_t start_ns = event.stamp_ns;
  const std::int64_t shift_ns = player.start(start_ns);
  if (!options.reference_out.empty()) write_shifted_reference(options, reader.manifest(), shift_ns);

  // Played packets all come from this program: a second lidar in the recording could not be told apart.
  const auto decoder = make_lidar_decoder(lidar);
  LidarSender sender(reader.manifest().lidar->sender);
  Progress progress("playing");
  do {
    if (options.for_s && seconds_between(start_ns, event.stamp_ns) > *options.for_s) break;
    const bool is_packet = event.kind == recording::EventKind::kLidarPacket;
    const bool is_played =
        !is_packet || sender.admits(*decoder, event.packet, event.sender_ipv4, event.stamp_ns);
    if (is_played) (void)player.send_when_due(event);
    progress.update(reader.progress());
  } while (reader.next(event));
  progress.finish();
}

void play(const PlayOptions& options) {
  if (options.loop && !options.reference_out.empty())
    throw UsageError("--reference-out: a reference has one time, and --loop plays it again and again");
  const recording::RecordingReader reader(options.recording);
  if (!reader.manifest().lidar) throw DataError(options.recording.string() + ": has no [lidar] to play");
  if (reader.manifest().lidar->holds_clouds()) {
    throw DataError(
        options.recording.string() +
        ": its lidar gave clouds, not packets: there is nothing to send by UDP; isobar replay reads it");
  }
  Player player(options.address, lidar_plan(options, *reader.manifest().lidar), options.input_port);
  do play_once(options, player);
  while (options.loop);
}

}  // namespace

void add_play_command(CLI::App& app) {
  const auto [command, options] =
      add_subcommand<PlayOptions>(app, "play", "Send a recording as UDP traffic in real time", play);
  command.add_option("RECORDING", options.recording, "recording folder")->required();
  command.add_option("--address", options.address, "IPv4 address of the machine that runs isobard")
      ->capture_default_str();
  command.add_option("--lidar-port", options.lidar_port,
                     "UDP port of the lidar packets (default: the recording's)");
  command.add_option("--info-port", options.info_port,
                     "UDP port of the lidar's packets for its second port (default: the recording's)");
  command.add_option("--input-port", options.input_port, "UDP port of the sample datagrams")
      ->capture_default_str();
  command.add_option("--reference-out", options.reference_out,
                     "folder for reference.tum and segments.csv, shifted to the time of playing");
  command.add_option("--start", options.start_s, "time into the recording at which to begin [s]")
      ->check(number_from_zero())
      ->capture_default_str();
  command.add_option("--for", options.for_s, "time to play [s] (default: to the end)")
      ->check(number_above_zero());
  command.add_flag(
      "--loop", options.loop,
      "begin anew at the end, until Ctrl-C; isobard sees clocks and robot jump back to the start");
}

}  // namespace isobar::tools
