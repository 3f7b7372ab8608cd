// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/output_thread.hpp"

#include <spdlog/spdlog.h>

#include <exception>

#include "daemon/message_loop.hpp"

namespace isobar {

OutputThread::OutputThread(files::RunOutput& output, ThreadSettings settings)
    : settings_(std::move(settings)),
      output_(&output),
      poses_(ipc::topics::kPose),
      priors_(ipc::topics::kPrior),
      waiter_({&poses_.raw()}) {}

OutputThread::~OutputThread() { stop(); }

void OutputThread::start() {
  thread_ = std::thread([this] { loop(); });
}

void OutputThread::stop() noexcept {
  waiter_.stop();
  if (thread_.joinable()) thread_.join();
}

void OutputThread::loop() noexcept {
  (void)apply_to_this_thread(settings_);
  drain_until_stopped(waiter_, heartbeat_, [this] { drain(); });
}

void OutputThread::drain() noexcept {
  if (const auto prior = priors_.take_latest()) newest_prior_ = *prior;
  while (const auto pose = poses_.take()) {
    if (output_ == nullptr) continue;
    try {
      output_->add_pose(*pose, newest_prior_);
    } catch (const std::exception& error) {
      spdlog::error("{}; poses are no longer written, they still go out", error.what());
      output_ = nullptr;
    }
  }
}

}  // namespace isobar
