// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/keys/key_files.hpp"

#include <fcntl.h>
#include <linux/fs.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <utility>

#include "core/errors.hpp"

namespace isobar::keys {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{64} * 1024;

/// File descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  ~Descriptor() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const noexcept { return descriptor_; }

 private:
  int descriptor_;
};

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
  throw ServiceError(path.string() + ": " + what + ": " + std::strerror(errno));
}

void refuse_existing(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::exists(std::filesystem::symlink_status(path, ignored))) {
    throw ServiceError(path.string() +
                       ": exists already; keys are never overwritten: choose another name, or move it away");
  }
}

std::string remedy_for(int reason) {
  if (reason != EACCES) return {};
  const passwd* user = ::getpwuid(::geteuid());
  return user == nullptr ? std::string() : std::string("; it must belong to user ") + user->pw_name;
}

/// Writes a new file with mode 0600, down to the disk: a key that exists twice after a power cut, or not at
/// all, is found by nobody.
void write_new(const std::filesystem::path& file, std::string_view text) {
  const Descriptor descriptor(
      ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (descriptor.get() < 0) fail(file, "cannot be made");
  for (std::size_t written = 0; written < text.size();) {
    const ssize_t count = ::write(descriptor.get(), text.data() + written, text.size() - written);
    if (count < 0) fail(file, "cannot be written");
    written += static_cast<std::size_t>(count);
  }
  if (::fsync(descriptor.get()) != 0) fail(file, "cannot be written");
}

}  // namespace

std::string read_key_file(const std::filesystem::path& file) {
  const std::string path = file.string();
  // Not blocking: a FIFO of that name would wait for a writer for ever.
  const Descriptor descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (descriptor.get() < 0) {
    const int reason = errno;
    throw DataError(path + ": cannot be read: " + std::strerror(reason) + remedy_for(reason));
  }
  struct stat status {};
  if (::fstat(descriptor.get(), &status) != 0 || !S_ISREG(status.st_mode)) {
    throw DataError(path + ": must be a file");
  }
  std::string text(kMaxBytes + 1, '\0');
  std::size_t length = 0;
  while (length < text.size()) {
    const ssize_t count = ::read(descriptor.get(), text.data() + length, text.size() - length);
    if (count < 0) throw DataError(path + ": cannot be read: " + std::strerror(errno));
    if (count == 0) break;
    length += static_cast<std::size_t>(count);
  }
  if (length > kMaxBytes) throw DataError(path + ": must have at most 64 KiB");
  text.resize(length);
  return text;
}

void replace_key_file(const std::filesystem::path& file, std::string_view text) {
  const std::filesystem::path beside = file.string() + ".new-" + std::to_string(::getpid());
  write_new(beside, text);
  if (::rename(beside.c_str(), file.c_str()) != 0) fail(file, "cannot be replaced");
}

NewFolder::NewFolder(std::filesystem::path final_place)
    : final_place_(std::move(final_place)),
      place_(final_place_.string() + ".new-" + std::to_string(::getpid())) {
  refuse_existing(final_place_);
  if (::mkdir(place_.c_str(), 0700) != 0) fail(final_place_, "cannot be made");
}

NewFolder::~NewFolder() {
  std::error_code ignored;
  if (!place_.empty()) std::filesystem::remove_all(place_, ignored);
}

void NewFolder::write(const char* name, std::string_view text) const { write_new(place_ / name, text); }

void NewFolder::make_folder(const char* name) const {
  const std::filesystem::path folder = place_ / name;
  if (::mkdir(folder.c_str(), 0700) != 0) fail(folder, "cannot be made");
}

void NewFolder::finish() {
  // RENAME_NOREPLACE: rename() alone would replace an empty folder.
  if (::renameat2(AT_FDCWD, place_.c_str(), AT_FDCWD, final_place_.c_str(), RENAME_NOREPLACE) != 0) {
    if (errno == EEXIST) refuse_existing(final_place_);
    fail(final_place_, "cannot be made");
  }
  place_.clear();
}

}  // namespace isobar::keys
