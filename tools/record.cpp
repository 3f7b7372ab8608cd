// SPDX-License-Identifier: BSD-3-Clause
// `isobar record`: writes all inputs of the running isobard to a recording folder.
#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "drivers/clock/robot_clock.hpp"
#include "run/recording/record_session.hpp"
#include "run/tile_store/file_descriptor.hpp"
#include "tools/commands.hpp"
#include "tools/number_option.hpp"
#include "tools/record_progress.hpp"
#include "tools/record_source.hpp"
#include "tools/subcommand.hpp"

#if ISOBAR_WITH_DDS
#include "tools/dds_options.hpp"
#include "tools/foxglove/record_topics.hpp"
#endif

namespace isobar::tools {
namespace {

constexpr std::int64_t kTickNs = 1'000'000'000;
/// Longest wait for the last inputs after a stop.
constexpr std::int64_t kStopLimitNs = 15 * kTickNs;
constexpr double kMbBytes = 1e6;

struct RecordOptions {
  std::filesystem::path folder;
  double min_free_mb = 500.0;
  double duration_s = 0.0;
  double timeout_s = 0.0;
  bool mcap = false;
#if ISOBAR_WITH_DDS
  DdsOptions dds;
#endif
};

/// The signals that end a recording, as a descriptor; blocked while this object lives.
class StopSignals {
 public:
  StopSignals() {
    sigset_t set;
    sigemptyset(&set);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&set, number);
    pthread_sigmask(SIG_BLOCK, &set, &before_);
    descriptor_ = FileDescriptor(signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK));
    if (!descriptor_) throw ServiceError("no signal descriptor: " + errno_message());
  }
  ~StopSignals() {
    signalfd_siginfo info{};
    while (::read(descriptor_.get(), &info, sizeof info) > 0) {
    }
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  [[nodiscard]] int descriptor() const { return descriptor_.get(); }

 private:
  sigset_t before_{};
  FileDescriptor descriptor_;
};

/// One run of `isobar record`.
class Recorder {
 public:
  explicit Recorder(const RecordOptions& options)
      : options_(options), session_(options.folder), started_ns_(monotonic_ns()) {
    std::error_code error;
    if (std::filesystem::exists(options.folder, error) && !std::filesystem::is_empty(options.folder, error)) {
      throw DataError(options.folder.string() + ": exists already; a recording is written to a new folder");
    }
    if (lacks_space()) throw ServiceError(why_ended_);
    buffer_.reserve(kReadBytes);
  }

  void run() {
    connect();
    while (read_some()) {
      if (monotonic_ns() >= next_tick_ns_) tick();
    }
    finish();
  }

 private:
  static constexpr std::size_t kReadBytes = std::size_t{1} << 20U;

  void connect() {
    source_.reset();
    source_ = std::make_unique<RecordSource>(/*quiet=*/attempts_++ > 0);
    session_.begin_attachment();
    buffer_.clear();
  }

  /// Waits for inputs and adds them. False when the recording has ended.
  bool read_some() {
    std::array<pollfd, 2> waits{pollfd{source_->descriptor(), POLLIN, 0},
                                pollfd{signals_.descriptor(), POLLIN, 0}};
    if (stopping_) waits[1].fd = -1;
    constexpr int kWaitMs = 100;
    if (::poll(waits.data(), waits.size(), kWaitMs) < 0 && errno != EINTR) return false;
    if (waits[1].revents != 0) stop();
    if (waits[0].revents == 0) return !stopping_ || monotonic_ns() - stopping_ns_ < kStopLimitNs;
    const std::size_t before = buffer_.size();
    buffer_.resize(before + kReadBytes);
    const ssize_t count = ::read(source_->descriptor(), buffer_.data() + before, kReadBytes);
    buffer_.resize(before + static_cast<std::size_t>(count > 0 ? count : 0));
    if (count == 0) return !stopping_ && reconnect();
    add_records();
    return true;
  }

  void add_records() {
    recording::InputLogReader reader(buffer_);
    recording::LogEntry entry;
    try {
      while (reader.next(entry)) session_.add(entry);
    } catch (const DataError& error) {
      throw ServiceError(std::string(error.what()) + "; the recording ends here");
    }
    buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(reader.consumed()));
    if (session_.started()) attempts_ = 0;
    print_notes();
  }

  /// After the end of a source. False when another one would not help.
  bool reconnect() {
    const int code = source_->exit_code();
    if (code == RecordSource::kRefused && !session_.started())
      throw ServiceError("isobard's inputs cannot be read, see above");
    // Of an isobard that starts again on a busy machine the description may only be late.
    if (code == RecordSource::kOtherVersion && !session_.started()) {
      throw ServiceError(
          "isobard does not describe itself to recorders: install isobard and isobar of one version");
    }
    if (session_.started() && attempts_ == 0) say("isobard has ended; waiting for it to start again");
    constexpr timespec kPause{0, 300'000'000};
    nanosleep(&kPause, nullptr);
    connect();
    return true;
  }

  void tick() {
    const std::int64_t now_ns = monotonic_ns();
    next_tick_ns_ = now_ns + kTickNs;
    try {
      session_.flush();
    } catch (const DataError& error) {
      throw ServiceError(std::string(error.what()) + "; the recording ends here");
    }
    if (!session_.started()) {
      wait_for_isobard(now_ns);
    } else {
      if (recording_ns_ == 0) recording_ns_ = now_ns;
      progress_.update({session_.counts(), session_.bytes(), recording::free_bytes(options_.folder),
                        session_.lost(), now_ns});
    }
    const bool over = recording_ns_ != 0 && options_.duration_s > 0.0 &&
                      static_cast<double>(now_ns - recording_ns_) * 1e-9 >= options_.duration_s;
    if (!stopping_ && (over || lacks_space())) stop();
  }

  void wait_for_isobard(std::int64_t now_ns) {
    if (!waiting_said_) say("waiting for isobard to run");
    waiting_said_ = true;
    if (options_.timeout_s > 0.0 && static_cast<double>(now_ns - started_ns_) * 1e-9 > options_.timeout_s) {
      throw ServiceError("no isobard has run for " + std::to_string(std::lround(options_.timeout_s)) + " s");
    }
  }

  bool lacks_space() {
    const double free_mb = static_cast<double>(recording::free_bytes(options_.folder)) / kMbBytes;
    if (free_mb >= options_.min_free_mb) return false;
    why_ended_ = options_.folder.string() + ": " + std::to_string(std::lround(free_mb)) +
                 " MB free on its disk, less than the " + std::to_string(std::lround(options_.min_free_mb)) +
                 " MB of --min-free; " +
                 (session_.started() ? "the recording has ended and is complete" : "nothing is recorded");
    return true;
  }

  void stop() {
    stopping_ = true;
    stopping_ns_ = monotonic_ns();
    source_->stop();
  }

  void finish() {
    session_.close();
    progress_.end_line();
    print_notes();
    const recording::LiveCounts counts = session_.counts();
    if (!session_.started()) {
      std::printf("nothing recorded: isobard did not run\n");
    }
    for (const auto& folder : session_.folders()) std::printf("written: %s\n", folder.c_str());
    if (session_.started()) {
      std::printf(
          "%llu packets, %llu imu, %llu barometer, %llu base station, %llu wheel samples; %llu lost\n",
          static_cast<unsigned long long>(counts.packets), static_cast<unsigned long long>(counts.imu),
          static_cast<unsigned long long>(counts.pressure),
          static_cast<unsigned long long>(counts.base_pressure),
          static_cast<unsigned long long>(counts.wheel), static_cast<unsigned long long>(session_.lost()));
    }
    if (!why_ended_.empty()) throw ServiceError(why_ended_);
  }

  void say(const std::string& sentence) {
    progress_.end_line();
    std::fprintf(stderr, "%s\n", sentence.c_str());
  }
  void print_notes() {
    for (const std::string& note : session_.take_notes()) say(note);
  }

  RecordOptions options_;
  StopSignals signals_;
  recording::RecordSession session_;
  RecordProgress progress_;
  std::unique_ptr<RecordSource> source_;
  std::vector<std::uint8_t> buffer_;  ///< received, not yet a whole record
  std::int64_t started_ns_;
  std::int64_t recording_ns_ = 0;  ///< start of the first folder; 0: none yet
  std::int64_t next_tick_ns_ = 0;
  unsigned attempts_ = 0;  ///< sources since the last one that delivered
  bool waiting_said_ = false;
  bool stopping_ = false;
  std::int64_t stopping_ns_ = 0;
  std::string why_ended_;
};

void run_record(const RecordOptions& options) {
  if (!options.mcap) {
    Recorder(options).run();
    return;
  }
#if ISOBAR_WITH_DDS
  const bool names_file = options.folder.extension() == ".mcap";
  record_topics({names_file ? options.folder : std::filesystem::path(options.folder.string() + ".mcap"),
                 options.duration_s, kMbBytes * options.min_free_mb, options.dds});
#else
  throw UsageError("--mcap: this isobar was built without DDS");
#endif
}

}  // namespace

void add_record_command(CLI::App& app) {
  const auto [command, options] = add_subcommand<RecordOptions>(
      app, "record", "Record all inputs of the running isobard to a folder", run_record);
  command.add_option("DIR", options.folder, "new folder; `isobar replay DIR` replays it")->required();
  command.add_flag(
      "--mcap", options.mcap,
      "record the topics of isobar-dds instead, to DIR.mcap: Foxglove opens it, replay does not");
#if ISOBAR_WITH_DDS
  add_dds_options(command, options.dds, " (with --mcap)");
#endif
  command
      .add_option("--min-free", options.min_free_mb,
                  "free space on the disk at which the recording ends [MB]")
      ->check(number_within(0.0, 1e9))
      ->capture_default_str();
  command.add_option("--for", options.duration_s, "end after this time [s]; 0: at Ctrl-C or SIGTERM")
      ->check(number_within(0.0, 1e9))
      ->capture_default_str();
  command
      .add_option("--timeout", options.timeout_s, "fail when no isobard runs within this time [s]; 0: wait")
      ->check(number_within(0.0, 1e6))
      ->capture_default_str();
}

}  // namespace isobar::tools
