// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/text_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "core/errors.hpp"
#include "run/files/part_file.hpp"

namespace isobar::files {

namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 18;  // few system calls per megabyte

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

std::string read_text_file(const std::filesystem::path& file, std::size_t max_bytes) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error))
    throw DataError(file.string() + ": is a directory, not a file");
  const std::unique_ptr<std::FILE, FileCloser> handle(std::fopen(file.c_str(), "rb"));
  if (!handle) throw DataError(file.string() + ": cannot be read: " + std::strerror(errno));
  std::string text;
  const auto size = std::filesystem::file_size(file, error);
  if (!error && size <= max_bytes) text.reserve(size);
  std::string block(kBufferBytes, '\0');
  for (;;) {
    const std::size_t got = std::fread(block.data(), 1, block.size(), handle.get());
    text.append(block, 0, got);
    if (text.size() > max_bytes)
      throw DataError(file.string() + ": is larger than " + std::to_string(max_bytes) + " bytes");
    if (got < block.size()) break;
  }
  if (std::ferror(handle.get()) != 0)
    throw DataError(file.string() + ": cannot be read: " + std::strerror(errno));
  return text;
}

void write_text_file(const std::filesystem::path& file, std::string_view text) {
  OutputFile out(file);
  out.write(text);
  out.close();
}

void replace_file(const std::filesystem::path& file, std::string_view content) {
  PartFile out(file);
  out.write(content);
  out.close();
}

OutputFile::OutputFile(std::filesystem::path file) : path_(std::move(file)) {
  file_.reset(std::fopen(path_.c_str(), "wb"));
  if (!file_) fail("cannot be created");
  if (std::setvbuf(file_.get(), nullptr, _IOFBF, kBufferBytes) != 0) fail("cannot be buffered");
}

void OutputFile::write(const void* data, std::size_t bytes) {
  if (bytes == 0) return;
  if (!file_) throw ServiceError(path_.string() + ": cannot be written: is closed");
  if (std::fwrite(data, 1, bytes, file_.get()) != bytes) fail("cannot be written");
}

void OutputFile::seek(long offset) {
  if (!file_ || std::fseek(file_.get(), offset, SEEK_SET) != 0) fail("cannot be written");
}

void OutputFile::sync() {
  if (!file_ || std::fflush(file_.get()) != 0) fail("cannot be written");
  if (::fdatasync(::fileno(file_.get())) != 0 && errno != EINVAL && errno != EROFS) {
    fail("cannot be written to the disk");
  }
}

void OutputFile::close() {
  if (!file_) return;
  if (std::fclose(file_.release()) != 0) fail("cannot be written");
}

void OutputFile::fail(const char* what) const {
  throw ServiceError(path_.string() + ": " + what + ": " + std::strerror(errno));
}

}  // namespace isobar::files
