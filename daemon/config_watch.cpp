// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/config_watch.hpp"

#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <string_view>
#include <system_error>

#include "config/config_layer.hpp"

namespace isobar {
namespace {

// No IN_MODIFY: a file that is being written is not read before it is closed.
constexpr std::uint32_t kChanges = IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM | IN_DELETE | IN_CREATE |
                                   IN_ATTRIB | IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR;

}  // namespace

ConfigWatch::ConfigWatch(const std::filesystem::path& main)
    : main_(main),
      folder_(main.has_parent_path() ? main.parent_path() : std::filesystem::path(".")),
      inotify_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
  watch_folders();
}

// Again for a folder that was replaced or came later; watching a folder twice gives the same number.
void ConfigWatch::watch_folders() {
  if (!inotify_) return;
  main_watch_ = ::inotify_add_watch(inotify_.get(), folder_.c_str(), kChanges);
  conf_d_watch_ = ::inotify_add_watch(inotify_.get(), (folder_ / kConfigFolder).c_str(), kChanges);
}

bool ConfigWatch::changed(Clock::time_point now) {
  constexpr std::chrono::seconds kRetry{1};
  bool came = false;
  if ((main_watch_ < 0 || conf_d_watch_ < 0) && now >= next_attempt_) {
    const bool had_main = main_watch_ >= 0;
    watch_folders();
    next_attempt_ = now + kRetry;
    came = conf_d_watch_ >= 0 || (!had_main && main_watch_ >= 0);  // what was written before the watch
  }
  if (read_events() || came) {
    if (!pending_) first_ = now;
    last_ = now;
    pending_ = true;
  }
  if (!pending_ || (now - last_ < kQuiet && now - first_ < kLongest)) return false;
  pending_ = false;
  return true;
}

bool ConfigWatch::read_events() {
  bool changed = false;
  alignas(inotify_event) std::array<char, 4096> buffer{};
  for (ssize_t size = 0; (size = ::read(inotify_.get(), buffer.data(), buffer.size())) > 0;) {
    for (ssize_t at = 0; at < size;) {
      const auto* event = reinterpret_cast<const inotify_event*>(buffer.data() + at);
      at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
      if ((event->mask & (IN_DELETE_SELF | IN_MOVE_SELF)) != 0U) {
        if ((event->mask & IN_MOVE_SELF) != 0U) ::inotify_rm_watch(inotify_.get(), event->wd);
        (event->wd == main_watch_ ? main_watch_ : conf_d_watch_) = -1;
        changed = true;
      } else if ((event->mask & IN_Q_OVERFLOW) != 0U) {
        changed = true;
      } else if ((event->mask & IN_IGNORED) == 0U) {
        changed = note(event->wd, event->mask, event->len > 0 ? event->name : "") || changed;
      }
    }
  }
  return changed;
}

/// Whether an event about a name tells a complete change.
bool ConfigWatch::note(int watch, std::uint32_t mask, const char* name) {
  if (!matters(watch, name)) return false;
  if (watch == main_watch_ && std::string_view(name) == kConfigFolder) {
    conf_d_watch_ = -1;  // another folder now
    next_attempt_ = {};
  }
  if ((mask & IN_CREATE) == 0U || (mask & IN_ISDIR) != 0U) return true;
  // A created file is written, and closed, next. A link, and what is no file at all, is complete.
  std::error_code ignored;
  const std::filesystem::path folder = watch == main_watch_ ? folder_ : folder_ / kConfigFolder;
  return !std::filesystem::is_regular_file(std::filesystem::symlink_status(folder / name, ignored));
}

/// Whether a name in a watched folder may belong to the configuration: isobar.toml, conf.d, *.toml in conf.d,
/// and "..data" and the like, through which Kubernetes swaps folders of links.
bool ConfigWatch::matters(int watch, const char* name) const {
  const std::string_view text(name);
  if (text.starts_with("..")) return true;
  if (watch == conf_d_watch_) return text.ends_with(".toml") && !text.starts_with(".");
  return text == main_.filename().native() || text == kConfigFolder;
}

}  // namespace isobar
