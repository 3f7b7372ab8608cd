// SPDX-License-Identifier: BSD-3-Clause
#include "run/text/text_lines.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace isobar::text {
namespace {

constexpr std::size_t kBufferBytes = 16 * TextLines::kMaxLineBytes;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

}  // namespace

TextLines::TextLines(const std::filesystem::path& file)
    : name_(file.string()), source_(std::make_unique<TextSource>(file)), buffer_(kBufferBytes) {}

TextLines::TextLines(std::string_view text, std::string name)
    : name_(std::move(name)), buffer_(text.size() + 1), end_(text.size()), at_end_(true) {
  std::copy(text.begin(), text.end(), buffer_.begin());
}

bool TextLines::refill() {
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  const std::size_t count = source_->read(buffer_.data() + end_, buffer_.size() - end_);
  end_ += count;
  at_end_ = count == 0;
  return !at_end_;
}

std::string TextLines::damage() const {
  if (source_ == nullptr || source_->damage().empty()) return {};
  return name_ + ": the compressed file is damaged: " + source_->damage();
}

void TextLines::skip_to_last(std::uint64_t bytes) {
  if (source_ == nullptr || !source_->skip_to_last(bytes, end_ - begin_)) return;
  begin_ = 0;
  end_ = 0;
  at_end_ = false;
  std::string_view part_of_a_line;
  next(part_of_a_line);
}

bool TextLines::next(std::string_view& line) {
  too_long_ = false;
  std::size_t searched = begin_;
  for (;;) {
    const void* found = std::memchr(buffer_.data() + searched, '\n', end_ - searched);
    if (found == nullptr && !at_end_) {
      if (end_ - begin_ > kMaxLineBytes) {
        too_long_ = true;
        begin_ = end_;  // drop the part read so far
      }
      const std::size_t unread = end_ - begin_;
      refill();
      searched = begin_ + unread;
      continue;
    }
    if (found == nullptr && begin_ == end_ && !too_long_) {
      return false;
    }
    const std::size_t stop =
        found == nullptr ? end_ : static_cast<std::size_t>(static_cast<const char*>(found) - buffer_.data());
    line = {buffer_.data() + begin_, stop - begin_};
    begin_ = found == nullptr ? end_ : stop + 1;
    without_end_ = found == nullptr;
    break;
  }
  ++line_number_;
  if (too_long_ || line.size() > kMaxLineBytes) {
    too_long_ = true;
    line = {};
  }
  if (line_number_ == 1 && line.starts_with(kByteOrderMark)) {
    line.remove_prefix(kByteOrderMark.size());
  }
  if (line.ends_with('\r')) {
    line.remove_suffix(1);
  }
  return true;
}

}  // namespace isobar::text
