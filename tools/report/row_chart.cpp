// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/row_chart.hpp"

#include <algorithm>
#include <utility>

namespace isobar::report {

namespace {

constexpr double kNameSizePx = 14.0;
constexpr double kMinNamesPx = 60.0;

double names_width(const std::vector<std::string>& names) {
  double width = kMinNamesPx;
  for (const std::string& name : names) width = std::max(width, text_width(name, kNameSizePx) + 18.0);
  return width;
}

}  // namespace

RowChart::RowChart(const RowLayout& layout, std::vector<std::string> names)
    : layout_(layout), names_(std::move(names)) {
  const double left = names_width(names_);
  frame_ = {left, layout_.top_margin, layout_.width - left - layout_.right_margin,
            layout_.row_height * static_cast<double>(names_.size())};
}

double RowChart::bottom(std::size_t row) const {
  return layout_.top_margin + layout_.row_height * static_cast<double>(row + 1);
}

double RowChart::middle(std::size_t row) const { return bottom(row) - 0.5 * layout_.row_height; }

void RowChart::draw_axis(Picture& picture, const Scale& x, const std::string& label) const {
  const Scale y = Scale::linear({0.0, 1.0}, frame_.bottom(), frame_.y, frame_.height);
  draw_axes(picture, {frame_, x, y, label, "", false, false});
}

void RowChart::draw_name(Picture& picture, std::size_t row) const {
  picture.text({frame_.x - 10.0, middle(row) + 5.0}, names_[row], {kNameSizePx, "#1f2937", "end"});
}

Picture RowChart::blank() const { return {layout_.width, frame_.bottom() + kBottomMarginPx}; }

}  // namespace isobar::report
