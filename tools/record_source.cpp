// SPDX-License-Identifier: BSD-3-Clause
#include "tools/record_source.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): sigaction is POSIX
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <utility>

#include "core/errors.hpp"
#include "daemon/input_tap.hpp"
#include "drivers/clock/robot_clock.hpp"
#include "ipc/service_view.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar::tools {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

constexpr std::int64_t kNsPerS = 1'000'000'000;
/// Time without a health report, which isobard sends once a second, after which the connection is useless.
constexpr std::int64_t kMaxSilenceNs = 10 * kNsPerS;
/// Time within which the description arrives after attaching.
constexpr std::int64_t kDescriptionNs = 5 * kNsPerS;
/// Most inputs that wait in memory while the disk is slow: a minute of an HDL-32E, 4 s of the
/// busiest Ouster. More are dropped, counted.
constexpr std::size_t kMaxWaitingBytes = std::size_t{160} << 20U;
/// Pause between two rounds: less than half of what the queues hold.
constexpr int kRoundMs = 20;
/// Time limits for attaching and detaching: milliseconds, but both block for ever when isobard ends in
/// between.
constexpr unsigned kAttachLimitS = 10;
constexpr unsigned kDetachLimitS = 4;

volatile sig_atomic_t g_source_stops = 0;

/// Writes logs to the pipe without blocking, so that a slow disk never fills the queues in shared memory.
class LogPipe {
 public:
  explicit LogPipe(int descriptor) : descriptor_(descriptor) {
    ::fcntl(descriptor, F_SETFL, O_NONBLOCK);
    ::fcntl(descriptor, F_SETPIPE_SZ, 1 << 20);  // refused without privileges above the limit: then 64 KiB
  }

  /// Where the next records go.
  [[nodiscard]] recording::InputLog& log() {
    if (waiting_.bytes().size() > kMaxWaitingBytes) {
      dropped_ += waiting_.records();
      waiting_.clear();
    }
    return waiting_;
  }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

  /// Writes as much as the pipe takes. False when nobody reads it any more.
  bool write_some() {
    for (;;) {
      if (written_ == going_.bytes().size()) {
        going_.clear();
        written_ = 0;
        std::swap(going_, waiting_);
        if (going_.bytes().empty()) return true;
      }
      const auto rest = going_.bytes().subspan(written_);
      const ssize_t count = ::write(descriptor_, rest.data(), rest.size());
      if (count < 0) return errno == EAGAIN || errno == EINTR;
      written_ += static_cast<std::size_t>(count);
    }
  }
  /// Waits for the next round, or until the pipe takes what is left: an Ouster's 40 MB/s are most of what the pipe holds
  /// in a round.
  void wait_for_round() const {
    pollfd writable{written_ < going_.bytes().size() ? descriptor_ : -1, POLLOUT, 0};
    ::poll(&writable, 1, kRoundMs);
  }
  /// Writes everything, for at most 10 s.
  void finish() {
    for (int rounds = 0; rounds < 500 && write_some(); ++rounds) {
      if (going_.bytes().empty()) return;
      pollfd writable{descriptor_, POLLOUT, 0};
      ::poll(&writable, 1, kRoundMs);
    }
  }

 private:
  int descriptor_;
  recording::InputLog going_;
  std::size_t written_ = 0;  // of going_
  recording::InputLog waiting_;
  std::uint64_t dropped_ = 0;
};

/// Whether the lidar of a described run gives clouds.
bool holds_clouds(std::string_view manifest_text) {
  std::vector<std::string> ignored;
  const recording::Manifest manifest =
      recording::parse_manifest(manifest_text, "description of isobard", ignored);
  return manifest.lidar && manifest.lidar->holds_clouds();
}

/// Ends with the parent, also when that is killed. Again after a change of user, which clears it.
void end_with(pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) std::_Exit(0);
}

std::unique_ptr<ipc::Attachment> attach(pid_t parent) {
  while (g_source_stops == 0) {
    ipc::enter_service_view();  // in each round: the service may start later
    end_with(parent);
    ::alarm(kAttachLimitS);
    try {
      auto attachment = std::make_unique<ipc::Attachment>("isobar-record", 400ms);
      ::alarm(0);
      return attachment;
    } catch (const ServiceError&) {
      // None runs yet; the parent process says so.
    }
  }
  return nullptr;
}

/// The attached child: hands over the inputs until it is asked to stop or isobard ends.
class Source {
 public:
  Source(int descriptor, const ipc::Attachment& attachment) : pipe_(descriptor), attachment_(attachment) {}

  int run() {
    const std::int64_t started_ns = monotonic_ns();
    last_health_ns_ = started_ns;
    while (g_source_stops == 0) {
      const std::int64_t now_ns = monotonic_ns();
      take(now_ns);
      if (!pipe_.write_some()) return 0;
      if (!described_ && now_ns - started_ns > kDescriptionNs) return RecordSource::kOtherVersion;
      if (!attachment_.broker_alive() || now_ns - last_health_ns_ > kMaxSilenceNs) {
        hand_over_rest(now_ns);
        return RecordSource::kBrokerEnded;
      }
      pipe_.wait_for_round();
    }
    hand_over_rest(monotonic_ns());
    return 0;
  }

 private:
  void take(std::int64_t now_ns) {
    recording::InputLog& log = pipe_.log();
    if (const auto description = descriptions_.take_latest()) {
      described_ = log.add_description(description->robot_clock_offset_ns, description->manifest(),
                                       description->settings());
      tap_.take_scans(holds_clouds(description->manifest()));
    }
    if (healths_.take_latest()) last_health_ns_ = now_ns;
    if (!described_) return;  // a recording begins with its manifest
    tap_.drain(log);
    if (now_ns - losses_ns_ > kNsPerS) {
      losses_ns_ = now_ns;
      log.add_losses(tap_.lost() + pipe_.dropped());
    }
  }
  void hand_over_rest(std::int64_t now_ns) {
    losses_ns_ = 0;
    take(now_ns);
    pipe_.finish();
  }

  LogPipe pipe_;
  const ipc::Attachment& attachment_;
  InputTap tap_;
  ipc::Subscriber<ipc::RunDescription> descriptions_{ipc::topics::kRunDescription};
  ipc::Subscriber<ipc::HealthReport> healths_{ipc::topics::kHealth};
  bool described_ = false;
  std::int64_t last_health_ns_ = 0;
  std::int64_t losses_ns_ = 0;
};

/// The child process.
[[noreturn]] void run_child(int descriptor, pid_t parent, bool quiet) {
  end_with(parent);
  struct sigaction on_stop {};
  on_stop.sa_handler = [](int) { g_source_stops = 1; };
  ::sigaction(SIGTERM, &on_stop, nullptr);
  // A terminal sends them to parent and child; the parent decides when the child ends.
  for (const int number : {SIGINT, SIGHUP, SIGPIPE}) ::signal(number, SIG_IGN);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  int code = RecordSource::kRefused;
  try {
    const auto attachment = attach(parent);
    if (attachment == nullptr) std::_Exit(0);
    code = RecordSource::kBrokerEnded;
    code = Source(descriptor, *attachment).run();
    if (code == RecordSource::kBrokerEnded) std::_Exit(code);  // detaching would wait for an answer
    ::close(descriptor);
    ::signal(SIGALRM, SIG_DFL);
    ::alarm(kDetachLimitS);
  } catch (const std::exception& error) {
    if (!quiet) std::fprintf(stderr, "isobar record: %s\n", error.what());
    std::_Exit(code);
  }
  std::exit(code);
}

}  // namespace

RecordSource::RecordSource(bool quiet) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw ServiceError("no pipe: " + errno_message());
  log_ = FileDescriptor(ends[0]);
  FileDescriptor write_end(ends[1]);
  std::fflush(nullptr);  // else the child would print buffered output a second time
  const pid_t parent = ::getpid();
  child_ = ::fork();
  if (child_ < 0) throw ServiceError("no process: " + errno_message());
  if (child_ == 0) {
    ::close(ends[0]);
    run_child(ends[1], parent, quiet);
  }
}

RecordSource::~RecordSource() {
  if (child_ <= 0) return;
  ::kill(child_, SIGKILL);
  ::waitpid(child_, nullptr, 0);
}

void RecordSource::stop() {
  if (child_ > 0) ::kill(child_, SIGTERM);
}

int RecordSource::exit_code() {
  int status = 0;
  // The pipe is closed before the child detaches: its end takes up to kDetachLimitS.
  if (child_ <= 0 || ::waitpid(child_, &status, 0) != child_) return 0;
  child_ = -1;
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace isobar::tools
