// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/black_box.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>
#include <sys/signalfd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <ctime>
#include <system_error>
#include <utility>

#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "daemon/black_box_folder.hpp"
#include "daemon/health_entry.hpp"
#include "daemon/run_description.hpp"
#include "drivers/clock/robot_clock.hpp"

namespace isobar::black_box {
namespace {

constexpr std::int64_t kStatePeriodNs = 1'000'000'000;
/// Most left-over rings that wait in memory to be saved: those of a crash loop must not fill it.
constexpr std::size_t kMostLeftOvers = 2;

sigset_t save_signal_set() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGUSR1);
  return set;
}

SaverSettings saver_settings(const Config& config) {
  return {save_folder(config), config.black_box.keep, config.black_box.min_free_mb};
}

std::time_t last_write(const std::filesystem::path& folder) {
  struct stat status {};
  std::time_t newest = 0;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (::stat(entry.path().c_str(), &status) == 0) newest = std::max(newest, status.st_mtime);
  }
  return newest != 0 ? newest : std::time(nullptr);
}

}  // namespace

void block_save_signal() {
  const sigset_t set = save_signal_set();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

std::unique_ptr<BlackBox> BlackBox::make(const Config& config) {
  if (config.black_box.span_s <= 0.0) return nullptr;
  try {
    return std::unique_ptr<BlackBox>(new BlackBox(config));
  } catch (const Error& error) {
    spdlog::warn("no black box: {}", error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    spdlog::warn("no black box: {}", error.what());
  }
  return nullptr;
}

BlackBox::BlackBox(const Config& config)
    : descriptions_(ipc::topics::kRunDescription),
      healths_(ipc::topics::kHealth),
      orders_(ipc::topics::kBlackBoxOrder),
      publisher_(ipc::topics::kBlackBoxState),
      trigger_(config.black_box.save_on),
      saver_(saver_settings(config)),
      worker_({.name = "blackbox"}, timer_, [this] { loop(); }) {
  const sigset_t set = save_signal_set();
  signal_ = FileDescriptor(signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK));
  memory_ = memory_folder();
  const bool can_save = !save_folder(config).empty();
  take_left_overs(can_save);
  constexpr double kNsPerS = 1e9;
  ring_ = std::make_unique<Ring>(make_ring_folder(memory_),
                                 static_cast<std::int64_t>(config.black_box.span_s * kNsPerS),
                                 ring_limit_bytes(memory_, config.black_box.max_mb));
  recording::InputLog head;
  (void)head.add_description(RobotClock::offset_ns(), recording::manifest_text(manifest_of(config)),
                             settings_in_force(config));
  ring_->set_head(head);
  tap_.take_scans(config.lidar.source == LidarSource::kDds);
  state_.limit_bytes = ring_->limit_bytes();
  spdlog::info("black box: the last {:.0f} s of all inputs, at most {} MB, in {}", config.black_box.span_s,
               ring_->limit_bytes() / 1'000'000, memory_.string());
  if (!can_save) {
    spdlog::warn("black box: cannot be saved: set black_box.directory or output.directory");
  }
}

BlackBox::~BlackBox() {
  worker_.stop();
  saver_.worker().stop();
  ring_->remove();
  std::error_code not_empty;  // left-overs that could not be saved wait for the next start
  std::filesystem::remove(memory_, not_empty);
}

void BlackBox::take_left_overs(bool can_save) {
  const std::vector<std::filesystem::path> rings = left_over_rings(memory_);
  for (std::size_t i = 0; i < rings.size(); ++i) {
    if (!can_save || i + kMostLeftOvers < rings.size()) {
      std::error_code ignored;
      std::filesystem::remove_all(rings[i], ignored);
      continue;
    }
    spdlog::warn("the run before did not end cleanly: its black box is saved in the background");
    saver_.submit({.segments = {}, .left_over = rings[i], .reason = "crash", .utc_s = last_write(rings[i])});
  }
}

void BlackBox::add_to(WorkerGroup& workers) {
  workers.add(saver_.worker(), Watch::kNo);
  workers.add(worker_, Watch::kNo);
}

void BlackBox::loop() noexcept {
  do {
    worker_.heartbeat().beat();
    try {
      round();
    } catch (const std::exception& error) {
      spdlog::error("black box: {}", error.what());
    }
  } while (timer_.sleep_for(InputTap::kDrainEveryNs));
}

void BlackBox::round() {
  const std::int64_t now_ns = monotonic_ns();
  take_description();
  log_.clear();
  tap_.drain(log_);
  if (!ring_->append(log_, now_ns)) refused_ += log_.records();
  take_orders(now_ns);
  take_results();
  if (now_ns - published_ns_ >= kStatePeriodNs) publish_state(now_ns);
}

void BlackBox::take_description() {
  const auto description = descriptions_.take_latest();
  if (!description) return;
  const std::string text = std::string(description->manifest()) + std::string(description->settings());
  if (text == head_text_) return;
  head_text_ = text;
  recording::InputLog head;
  (void)head.add_description(description->robot_clock_offset_ns, description->manifest(),
                             description->settings());
  ring_->set_head(head);
}

void BlackBox::take_orders(std::int64_t now_ns) {
  while (const auto order = orders_.take()) {
    const std::string_view reason(order->reason, strnlen(order->reason, sizeof order->reason));
    save(std::string(reason), order->number);
  }
  signalfd_siginfo info{};
  if (signal_ && ::read(signal_.get(), &info, sizeof info) > 0) save("signal", 0);
  while (const auto report = healths_.take()) {
    const auto fault = trigger_.check(*report, now_ns);
    if (!fault) continue;
    spdlog::warn("{} is faulty: the black box is saved", *fault);
    save("fault-" + *fault, 0);
  }
}

void BlackBox::save(const std::string& reason, std::uint64_t order) {
  saver_.submit({.segments = ring_->open_all(),
                 .left_over = {},
                 .reason = reason,
                 .utc_s = std::time(nullptr),
                 .order = order});
}

void BlackBox::take_results() {
  for (const SaveResult& result : saver_.take_results()) {
    ++(result.failed ? state_.failed : state_.saved);
    if (result.order != 0) state_.answered = result.order;
    state_.last_failed = result.failed;
    ipc::copy_to_field(result.text, state_.last);
    published_ns_ = 0;
  }
}

void BlackBox::publish_state(std::int64_t now_ns) {
  published_ns_ = now_ns;
  state_.held_ns = ring_->held_ns(now_ns);
  state_.held_bytes = ring_->held_bytes();
  state_.dropped = tap_.lost() + refused_;
  publisher_.send(state_);
  const std::lock_guard lock(shared_mutex_);
  shared_state_ = state_;
}

void BlackBox::fill_health(ipc::HealthReport& report) const {
  ipc::BlackBoxState state;
  {
    const std::lock_guard lock(shared_mutex_);
    state = shared_state_;
  }
  if (state.last_failed) {
    add_entry(report, "black_box", ipc::HealthLevel::kWarning, std::string("not saved: ") + state.last,
              static_cast<double>(state.failed));
    return;
  }
  add_entry(report, "black_box", ipc::HealthLevel::kOk,
            fmt::format("holds {:.0f} s in {:.0f} MB, {} lost", static_cast<double>(state.held_ns) * 1e-9,
                        static_cast<double>(state.held_bytes) * 1e-6, state.dropped),
            static_cast<double>(state.held_ns) * 1e-9);
}

}  // namespace isobar::black_box
