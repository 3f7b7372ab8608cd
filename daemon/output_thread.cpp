// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/output_thread.hpp"

#include <spdlog/spdlog.h>

#include <exception>

#include "daemon/message_loop.hpp"

namespace isobar {

OutputThread::OutputThread(files::RunOutput& output, ThreadSettings settings)
    : output_(&output),
      poses_(ipc::topics::kPose),
      priors_(ipc::topics::kPrior),
      waiter_({&poses_.raw()}),
      worker_(std::move(settings), waiter_, [this] { loop(); }) {}

void OutputThread::loop() noexcept {
  drain_until_stopped(waiter_, worker_.heartbeat(), [this] { drain(); });
}

void OutputThread::drain() noexcept {
  if (const auto prior = priors_.take_latest()) newest_prior_ = *prior;
  while (const auto pose = poses_.take()) {
    if (output_ == nullptr) continue;
    try {
      output_->add_pose(*pose, newest_prior_);
    } catch (const std::exception& error) {
      spdlog::error("{}; poses are still published but no longer written", error.what());
      output_ = nullptr;
    }
  }
}

}  // namespace isobar
