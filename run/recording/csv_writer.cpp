// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/csv_writer.hpp"

#include <cerrno>
#include <charconv>
#include <cstring>

#include "core/errors.hpp"

namespace isobar::recording {

namespace {

constexpr std::size_t kTextBufferBytes = std::size_t{1} << 16U;

}  // namespace

TextFile::TextFile(const std::filesystem::path& file)
    : name_(file.string()),
      buffer_(std::make_unique<char[]>(kTextBufferBytes)),  // NOLINT(modernize-avoid-c-arrays)
      file_(std::fopen(file.c_str(), "wb")) {
  if (file_ == nullptr) {
    throw DataError(name_ + ": cannot be written: " + std::strerror(errno));
  }
  std::setvbuf(file_.get(), buffer_.get(), _IOFBF, kTextBufferBytes);
}

void TextFile::flush_buffer() {
  if (std::fflush(file_.get()) != 0 && error_ == 0) {
    error_ = errno;
  }
  pending_ = 0;
}

void TextFile::flush() {
  if (file_ != nullptr) {
    flush_buffer();
  }
  if (error_ != 0) {
    throw DataError(name_ + ": could not be written completely: " + std::strerror(error_));
  }
}

void TextFile::close() {
  if (file_ == nullptr) {
    return;
  }
  flush_buffer();
  file_.reset();
  flush();
}

void TextFile::write(std::string_view text) {
  if (file_ == nullptr) {
    throw DataError(name_ + ": cannot be written: it is closed");
  }
  if (pending_ + text.size() > kTextBufferBytes) {
    flush_buffer();
  }
  pending_ += text.size();
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size() && error_ == 0) {
    error_ = errno;
  }
}

void CsvRow::separate() {
  if (used_ > 0) {
    text_[used_++] = ',';
  }
}

CsvRow& CsvRow::add(double value) {
  separate();
  used_ = static_cast<std::size_t>(std::to_chars(text_ + used_, text_ + kCapacity - 2, value).ptr - text_);
  return *this;
}

CsvRow& CsvRow::add(std::int64_t value) {
  separate();
  used_ = static_cast<std::size_t>(std::to_chars(text_ + used_, text_ + kCapacity - 2, value).ptr - text_);
  return *this;
}

std::string_view CsvRow::finish() {
  text_[used_++] = '\n';
  return {text_, used_};
}

}  // namespace isobar::recording
