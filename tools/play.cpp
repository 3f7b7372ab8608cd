// SPDX-License-Identifier: BSD-3-Clause
// `isobar play`: a recording as live traffic. Lidar packets go to the lidar's port, all other samples as
// datagrams (drivers/datagram/datagram.hpp) to the input port, each at its time.
#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <thread>

#include "core/errors.hpp"
#include "drivers/datagram/datagram.hpp"
#include "drivers/datagram/udp.hpp"
#include "drivers/recording/recording_reader.hpp"
#include "drivers/recording/reference.hpp"
#include "tools/commands.hpp"
#include "tools/progress.hpp"
#include "tools/report/text_file.hpp"

namespace isobar::tools {

namespace {

struct PlayOptions {
  std::filesystem::path recording;
  std::string address = "127.0.0.1";
  std::uint16_t lidar_port = 0;  ///< 0: the recording's
  std::uint16_t input_port = datagram::kDefaultPort;
  std::filesystem::path reference_out;
};

/// Sends events, each as the driver on the robot would.
class Player {
 public:
  Player(const PlayOptions& options, std::uint16_t lidar_port)
      : lidar_(options.address, lidar_port), samples_(options.address, options.input_port) {}

  void send(const recording::Event& event, std::int64_t shift_ns) {
    if (event.kind == recording::EventKind::kLidarPacket) {
      lidar_.send(event.packet);
      return;
    }
    datagram::Sample sample = sample_of(event);
    sample.set_stamp_ns(sample.stamp_ns() + shift_ns);
    sample.sequence = sequence_[static_cast<std::size_t>(sample.kind)]++;
    std::array<char, datagram::kMaxLineBytes> line{};
    const std::size_t length = datagram::format_line(sample, line);
    samples_.send({reinterpret_cast<const std::uint8_t*>(line.data()), length});
  }

 private:
  static datagram::Sample sample_of(const recording::Event& event) {
    datagram::Sample sample;
    switch (event.kind) {
      case recording::EventKind::kImu:
        sample.kind = datagram::Kind::kImu;
        sample.imu = event.imu;
        break;
      case recording::EventKind::kPressure:
        sample.kind = datagram::Kind::kPressure;
        sample.pressure = event.pressure;
        break;
      case recording::EventKind::kBasePressure:
        sample.kind = datagram::Kind::kBasePressure;
        sample.pressure = event.pressure;
        break;
      case recording::EventKind::kWheel:
        sample.kind = datagram::Kind::kWheel;
        sample.wheel = event.wheel;
        break;
      case recording::EventKind::kLidarPacket:
        break;
    }
    return sample;
  }

  UdpSender lidar_;
  UdpSender samples_;
  std::array<std::uint32_t, datagram::kKinds> sequence_{};
};

/// Writes reference and segments at the times at which they were played, for an evaluation of the live run.
void write_shifted_reference(const PlayOptions& options, const recording::Manifest& manifest,
                             std::int64_t shift_ns) {
  if (!manifest.reference) throw DataError(options.recording.string() + ": has no reference to shift");
  std::filesystem::create_directories(options.reference_out);
  auto poses = recording::read_tum(options.recording / manifest.reference->file);
  for (auto& pose : poses) pose.stamp_ns += shift_ns;
  recording::write_tum(options.reference_out / "reference.tum", poses);
  const auto segments_file = options.recording / recording::kSegmentsFile;
  if (!std::filesystem::exists(segments_file)) return;
  const auto segments = recording::read_segments(segments_file);
  report::OutputFile file(options.reference_out / recording::kSegmentsFile);
  file.write("t_start_ns,t_end_ns,label\n");
  for (const auto& segment : segments) {
    file.write(std::to_string(segment.start_ns + shift_ns) + "," + std::to_string(segment.end_ns + shift_ns) +
               "," + segment.label + "\n");
  }
  file.close();
}

void play(const PlayOptions& options) {
  recording::RecordingReader reader(options.recording);
  if (!reader.manifest().lidar) throw DataError(options.recording.string() + ": has no [lidar] to play");
  Player player(options, options.lidar_port != 0 ? options.lidar_port : reader.manifest().lidar->port);

  recording::Event event;
  if (!reader.next(event)) throw DataError(options.recording.string() + ": holds no samples");
  const std::int64_t first_ns = event.stamp_ns;
  // A moment for the first samples of all streams to be due in order.
  const std::int64_t shift_ns = RobotClock::now_ns() + 200'000'000 - first_ns;
  if (!options.reference_out.empty()) write_shifted_reference(options, reader.manifest(), shift_ns);

  const auto started = std::chrono::steady_clock::now() + std::chrono::milliseconds(200);
  Progress progress("playing");
  do {
    std::this_thread::sleep_until(started + std::chrono::nanoseconds(event.stamp_ns - first_ns));
    player.send(event, shift_ns);
    progress.update(reader.progress());
  } while (reader.next(event));
  progress.finish();
}

}  // namespace

void add_play_command(CLI::App& app) {
  auto options = std::make_shared<PlayOptions>();
  CLI::App* command = app.add_subcommand("play", "Send a recording as live UDP traffic, in real time");
  command->add_option("RECORDING", options->recording, "recording folder")->required();
  command->add_option("--address", options->address, "where isobard listens")->capture_default_str();
  command->add_option("--lidar-port", options->lidar_port,
                      "UDP port of the lidar packets (default: the recording's)");
  command->add_option("--input-port", options->input_port, "UDP port of the sample datagrams")
      ->capture_default_str();
  command->add_option("--reference-out", options->reference_out,
                      "folder for reference.tum and segments.csv, shifted to the time of playing");
  command->callback([options] { play(*options); });
}

}  // namespace isobar::tools
