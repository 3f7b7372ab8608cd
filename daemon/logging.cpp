// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/logging.hpp"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/sinks/systemd_sink.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>

namespace isobar {
namespace {

// A child whose stderr was redirected inherits the variable but not the stream: device and inode must match.
bool stderr_is_the_journal() {
  const char* journal = std::getenv("JOURNAL_STREAM");
  struct stat stream {};
  if (journal == nullptr || fstat(STDERR_FILENO, &stream) != 0) return false;
  return journal == std::to_string(stream.st_dev) + ":" + std::to_string(stream.st_ino);
}

}  // namespace

void set_up_logging(const std::string& program) {
  if (stderr_is_the_journal()) {
    // The journal stores time and priority itself, so the message goes unformatted.
    spdlog::set_default_logger(spdlog::systemd_logger_mt(program, program));
  } else {
    spdlog::set_default_logger(spdlog::stderr_logger_mt(program));
    spdlog::set_pattern("%Y-%m-%d %H:%M:%S.%e %n %l: %v");
  }
}

}  // namespace isobar
