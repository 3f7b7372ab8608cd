// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/logging.hpp"

#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

// The place in Isobar's sources says nothing to who reads a journal.
#define SD_JOURNAL_SUPPRESS_LOCATION
#include <systemd/sd-journal.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <string_view>
#include <vector>

namespace isobar {
namespace {

/// Sockets of the journal daemon: of entries with fields, and the stream to which systemd connects stdout and stderr of services.
constexpr const char* kJournalSocketPath = "/run/systemd/journal/socket";
constexpr std::string_view kJournalStreamPath = "/run/systemd/journal/stdout";

/// SYSLOG_IDENTIFIER; empty: stderr is not the journal. Written once, before the first thread.
std::string& journal_identifier() {
  static std::string identifier;
  return identifier;
}

// A child whose stderr was redirected inherits the variable but not the stream: device and inode must match.
bool is_named_journal_stream() {
  const char* journal = std::getenv("JOURNAL_STREAM");
  struct stat stream {};
  if (journal == nullptr || fstat(STDERR_FILENO, &stream) != 0) return false;
  return journal == std::to_string(stream.st_dev) + ":" + std::to_string(stream.st_ino);
}

// Without the variable, as after sudo, which clears it.
bool is_connected_to_the_journal() {
  sockaddr_un peer{};
  socklen_t length = sizeof(peer);
  return getpeername(STDERR_FILENO, reinterpret_cast<sockaddr*>(&peer), &length) == 0 &&  // NOLINT
         peer.sun_family == AF_UNIX && kJournalStreamPath == peer.sun_path;
}

int priority_of(spdlog::level::level_enum level) {
  switch (level) {
    case spdlog::level::critical:
      return 2;
    case spdlog::level::err:
      return 3;
    case spdlog::level::warn:
      return 4;
    case spdlog::level::info:
      return 6;
    default:
      return 7;
  }
}

/// Sends one entry to the journal; if it does not take it, a line with its priority to stderr (sd-daemon(3)).
void send_to_journal(int priority, std::string_view text, std::vector<std::string> fields) {
  fields.push_back("MESSAGE=" + std::string(text));
  fields.push_back("PRIORITY=" + std::to_string(priority));
  fields.push_back("SYSLOG_IDENTIFIER=" + journal_identifier());
  std::vector<iovec> parts;
  parts.reserve(fields.size());
  for (std::string& field : fields) parts.push_back({field.data(), field.size()});
  // The library reports success where the socket does not exist.
  if (access(kJournalSocketPath, W_OK) != 0 ||
      sd_journal_sendv(parts.data(), static_cast<int>(parts.size())) < 0) {
    std::fprintf(stderr, "<%d>%.*s\n", priority, static_cast<int>(text.size()), text.data());
  }
}

class JournalSink final : public spdlog::sinks::base_sink<std::mutex> {
 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    send_to_journal(priority_of(message.level), {message.payload.data(), message.payload.size()}, {});
  }
  void flush_() override {}
};

}  // namespace

void set_up_logging(const std::string& program) {
  if (is_named_journal_stream() || is_connected_to_the_journal()) {
    journal_identifier() = program;
    spdlog::set_default_logger(std::make_shared<spdlog::logger>(program, std::make_shared<JournalSink>()));
  } else {
    spdlog::set_default_logger(spdlog::stderr_logger_mt(program));
    spdlog::set_pattern("%Y-%m-%d %H:%M:%S.%e %n %l: %v");
  }
}

void log_info(const std::string& text) { spdlog::info("{}", text); }
void log_warning(const std::string& text) { spdlog::warn("{}", text); }

void log_change(const LevelChange& change) {
  const spdlog::level::level_enum level = !change.is_fault                           ? spdlog::level::info
                                          : change.level == ipc::HealthLevel::kError ? spdlog::level::err
                                                                                     : spdlog::level::warn;
  const std::string text = change.text.empty() ? change.name : change.name + ": " + change.text;
  if (journal_identifier().empty()) {
    spdlog::log(level, "{}", text);
    return;
  }
  send_to_journal(
      priority_of(level), text,
      {"ISOBAR_ENTRY=" + change.name, std::string("ISOBAR_LEVEL=") + ipc::level_name(change.level),
       "ISOBAR_VALUE=" + std::to_string(change.value)});
}

}  // namespace isobar
