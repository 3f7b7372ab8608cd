// SPDX-License-Identifier: BSD-3-Clause
#include "tests/integration/replay/recordings.hpp"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "run/evaluation/evaluated_run.hpp"
#include "run/recording/reference.hpp"
#include "simulation/simulate.hpp"

namespace isobar::test {

namespace {

/// Folder of all files that the tests write, removed when the process ends.
class Workspace {
 public:
  Workspace()
      : root_(std::filesystem::temp_directory_path() / ("isobar-replay-test-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(root_);
  }
  ~Workspace() {
    std::error_code ignored;
    std::filesystem::remove_all(root_, ignored);
  }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;
  [[nodiscard]] const std::filesystem::path& root() const { return root_; }

 private:
  std::filesystem::path root_;
};

const Workspace& workspace() {
  static const Workspace kWorkspace;
  return kWorkspace;
}

}  // namespace

std::filesystem::path fresh_folder(const std::string& name) {
  static int counter = 0;
  return workspace().root() / (name + "-" + std::to_string(++counter));
}

const std::filesystem::path& short_drive() {
  static const std::filesystem::path kRecording = [] {
    simulation::ScenarioRequest request;
    request.name = "stairs-demo";
    request.seed = 3;
    request.stop_after_s = 14.0;
    const std::filesystem::path folder = fresh_folder("drive");
    simulation::simulate(request, folder, {});
    return folder;
  }();
  return kRecording;
}

void write_event(const recording::Event& event, const recording::Manifest& manifest,
                 recording::RecordingWriter& writer) {
  switch (event.kind) {
    case recording::EventKind::kLidarPacket:
      if (manifest.lidar) writer.add_packet(event.stamp_ns, event.packet, event.port, event.sender_ipv4);
      break;
    case recording::EventKind::kImu:
      if (manifest.imu) writer.add_imu(event.imu);
      break;
    case recording::EventKind::kPressure:
      if (manifest.barometer) writer.add_pressure(event.pressure);
      break;
    case recording::EventKind::kBasePressure:
      if (manifest.base_barometer) writer.add_base_pressure(event.pressure);
      break;
    case recording::EventKind::kWheel:
      if (manifest.wheel) writer.add_wheel(event.wheel);
      break;
    case recording::EventKind::kCloud:
      writer.add_cloud(*event.cloud);
      break;
  }
}

std::filesystem::path copy_with(const std::filesystem::path& from, const std::string& name,
                                const std::function<void(recording::Manifest&)>& change_manifest,
                                const CopyEvent& copy_event) {
  recording::RecordingReader reader(from);
  recording::Manifest manifest = reader.manifest();
  if (change_manifest) change_manifest(manifest);
  const std::filesystem::path folder = fresh_folder(name);
  recording::RecordingWriter writer(folder, manifest);
  recording::Event event;
  while (reader.next(event)) {
    if (copy_event) {
      copy_event(event, writer);
    } else {
      write_event(event, manifest, writer);
    }
  }
  for (const auto& pose : recording::read_tum(from / reader.manifest().reference->file)) {
    writer.add_reference(pose.stamp_ns, pose.T_map_base);
  }
  writer.close();
  return folder;
}

ReplaySummary run(const std::filesystem::path& recording, std::filesystem::path& out, Method method) {
  Config config;
  config.method = method;
  out = fresh_folder("run");
  return replay(recording, config, out, [](double) {});
}

std::uint64_t count_of(const ReplaySummary& summary, const std::string& name) {
  for (const files::RunCount& count : summary.counts) {
    if (count.name == name) return count.count;
  }
  return 0;
}

double largest_error_m(const std::filesystem::path& recording, const std::filesystem::path& out) {
  const auto evaluated = evaluation::evaluate_methods(evaluation::load_reference(recording), {{"run", out}});
  return evaluated.methods.at(0).evaluation.figures.ate_max_m;
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace isobar::test
