// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/output_thread.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "daemon/message_loop.hpp"
#include "drivers/clock/robot_clock.hpp"

namespace isobar {
namespace {

/// Interval of writes: a power cut loses this and the time of one write.
constexpr std::int64_t kWriteIntervalNs = 500'000'000;
constexpr std::chrono::milliseconds kPoll(100);
/// The same of the checkpoint beside the tiles: the datum changes slowly.
constexpr std::int64_t kMapIntervalNs = 10'000'000'000;

}  // namespace

OutputThread::OutputThread(RunFiles& files, std::function<HeightDatum()> datum, ThreadSettings settings)
    : files_(files),
      datum_(std::move(datum)),
      checkpoint_file_(files.checkpoint_file()),
      poses_(ipc::topics::kPose),
      priors_(ipc::topics::kPrior),
      waiter_({&poses_.raw()}),
      checkpoint_(files.stations()),
      worker_(std::move(settings), waiter_, [this] { loop(); }) {
  draft_status_.present = true;
  status_.put(draft_status_);
}

void OutputThread::loop() noexcept {
  drain_until_stopped(
      waiter_, worker_.heartbeat(), [this] { drain(); }, [] { return kPoll; });
  stopping_ = true;
  write();
}

void OutputThread::drain() noexcept {
  if (const auto prior = priors_.take_latest()) newest_prior_ = *prior;
  while (const auto pose = poses_.take()) add_pose(*pose);
  if (RobotClock::now_ns() - written_ns_ >= kWriteIntervalNs) write();
}

void OutputThread::add_pose(const PoseEstimate& pose) noexcept {
  ++draft_status_.poses;
  checkpoint_.note(pose);
  if (files_.output() == nullptr || place_unknown(pose)) return;
  try {
    files_.output()->add_pose(pose, newest_prior_);
  } catch (const std::exception& error) {
    add_failure_ = error.what();
  }
}

void OutputThread::write() noexcept {
  std::string failure = std::exchange(add_failure_, {});
  const auto attempt = [&](const auto& part) {
    try {
      part();
    } catch (const std::exception& error) {
      if (failure.empty()) failure = error.what();
    }
  };
  if (files_.output() != nullptr) {
    attempt([&] { files_.output()->flush(); });
    attempt([&] { files_.output()->sync(); });
    draft_status_.dropped_lines = files_.output()->dropped_lines();
  }
  attempt([&] { write_checkpoint(); });
  if (!files_.maps().flush()) failure = "the map's tiles cannot be written to the disk";
  report(failure);
  written_ns_ = RobotClock::now_ns();
}

void OutputThread::write_checkpoint() {
  if (!checkpoint_.due() || checkpoint_file_.empty()) return;
  const files::Checkpoint checkpoint = checkpoint_.at(RobotClock::now_ns(), datum_());
  files::write_checkpoint(checkpoint_file_, checkpoint);
  checkpoint_.written();
  write_map_checkpoint(checkpoint);
}

// Beside the tiles, so that the folder of the map suffices for another run.
void OutputThread::write_map_checkpoint(const files::Checkpoint& checkpoint) {
  const MapStores& maps = files_.maps();
  if (!maps.configured() || maps.read_only()) return;
  const bool is_due = checkpoint.session != map_session_ || stopping_ ||
                      checkpoint.clock_ns - map_written_ns_ >= kMapIntervalNs;
  const auto file = maps.folder_of(checkpoint.session) / files::kCheckpointFile;
  if (!is_due || file == checkpoint_file_ || !std::filesystem::exists(file.parent_path())) return;
  files::write_checkpoint(file, checkpoint);
  map_session_ = checkpoint.session;
  map_written_ns_ = checkpoint.clock_ns;
}

void OutputThread::report(const std::string& failure) noexcept {
  const bool failing = !failure.empty();
  if (failing && !draft_status_.failing) {
    spdlog::error("{}; poses continue, and writing resumes when the disk allows", failure);
  }
  if (!failing && draft_status_.failing) spdlog::info("writing to the disk has resumed");
  draft_status_.failing = failing;
  draft_status_.reason.fill('\0');
  std::copy_n(failure.begin(), std::min(failure.size(), draft_status_.reason.size() - 1),
              draft_status_.reason.begin());
  status_.put(draft_status_);
}

}  // namespace isobar
