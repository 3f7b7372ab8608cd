// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/scale.hpp"

#include <algorithm>
#include <cmath>

namespace isobar::report {

namespace {

constexpr const char* kGridColour = "#e5e7eb";
constexpr const char* kFrameColour = "#9ca3af";
constexpr const char* kTickColour = "#4b5563";
constexpr double kTickSizePx = 12.0;
constexpr double kLegendRowPx = 20.0;
constexpr double kLegendSamplePx = 26.0;
constexpr double kLegendGapPx = 20.0;
// Bounds the loop where a step is lost in the rounding of a large value.
constexpr std::size_t kMaxTicks = 60;
// Logarithmic axes up to this width get ticks at 1, 2 and 5 of each decade, wider ones at 1 only.
constexpr double kMaxDecadesWithAllTicks = 3.0;

/// The smallest of 1, 2, 5 times a power of ten that is at least `rough`.
double round_step(double rough) {
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * (1.0 - 1e-9)) return factor * power;
  }
  return 10.0 * power;
}

std::string tick_label(double value, int decimals) {
  std::string text = fixed(value, decimals);
  if (text.front() == '-') text.replace(0, 1, "\u2212");
  return text;
}

double entry_width(const LegendEntry& entry) {
  return kLegendSamplePx + 7.0 + text_width(entry.name, 13.0) + kLegendGapPx;
}

/// Calls visit(entry, x_px, row) for each entry; returns the number of rows.
template <typename Visit>
int lay_out_legend(double width, const std::vector<LegendEntry>& entries, Visit&& visit) {
  double x = 0.0;
  int row = 0;
  for (const LegendEntry& entry : entries) {
    if (x > 0.0 && x + entry_width(entry) - kLegendGapPx > width) {
      x = 0.0;
      ++row;
    }
    visit(entry, x, row);
    x += entry_width(entry);
  }
  return entries.empty() ? 0 : row + 1;
}

}  // namespace

Range range_of(const std::vector<double>& values) {
  Range range{INFINITY, -INFINITY};
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }
  return range.low <= range.high ? range : Range{0.0, 1.0};
}

Range united(const Range& a, const Range& b) { return {std::min(a.low, b.low), std::max(a.high, b.high)}; }

Range padded(const Range& range, double share, double min_width) {
  const double missing = std::max(0.0, min_width - (range.high - range.low));
  const double margin = 0.5 * missing + share * (range.high - range.low + missing);
  return {range.low - margin, range.high + margin};
}

Scale::Scale(const Range& values, double px_low, double px_high, bool is_log)
    : range_(values), px_low_(px_low), px_high_(px_high), is_log_(is_log) {}

Scale Scale::linear(const Range& values, double px_low, double px_high, double tick_px) {
  Scale scale(values, px_low, px_high, false);
  const double width = values.high - values.low;
  const double count = std::max(1.0, std::abs(px_high - px_low) / tick_px);
  const double step = round_step(width / count);
  if (!std::isfinite(step) || !(step > 0.0)) return scale;  // an empty or endless range has no ticks
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
  const double first = std::ceil(values.low / step - 1e-6);
  for (double i = first; i * step <= values.high + 1e-6 * step && scale.ticks_.size() < kMaxTicks; i += 1.0) {
    scale.ticks_.push_back({i * step, tick_label(i * step, decimals)});
  }
  return scale;
}

Scale Scale::logarithmic(const Range& values, double px_low, double px_high) {
  Scale scale(values, px_low, px_high, true);
  if (!(values.low > 0.0) || !std::isfinite(values.high)) return scale;
  const bool is_wide = std::log10(values.high / values.low) > kMaxDecadesWithAllTicks;
  for (int exponent = static_cast<int>(std::floor(std::log10(values.low))); exponent < 12; ++exponent) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double value = factor * std::pow(10.0, exponent);
      if (is_wide && factor != 1.0) continue;
      if (value < values.low * (1.0 - 1e-9) || value > values.high * (1.0 + 1e-9)) continue;
      scale.ticks_.push_back({value, tick_label(value, std::max(0, -exponent))});
    }
  }
  return scale;
}

double Scale::operator()(double value) const {
  const auto along = [&](double v) { return is_log_ ? std::log10(v) : v; };
  const double share = (along(value) - along(range_.low)) / (along(range_.high) - along(range_.low));
  return px_low_ + share * (px_high_ - px_low_);
}

double Scale::clamped(double value) const { return (*this)(std::clamp(value, range_.low, range_.high)); }

void draw_axes(Picture& picture, const Axes& axes) {
  const Box& frame = axes.frame;
  for (const Tick& tick : axes.x.ticks()) {
    const double x = axes.x(tick.value);
    picture.line({x, frame.y}, {x, frame.bottom()}, {kGridColour});
    picture.text({x, frame.bottom() + 17.0}, tick.label, {kTickSizePx, kTickColour, "middle"});
  }
  for (const Tick& tick : axes.y.ticks()) {
    const double y = axes.y(tick.value);
    if (axes.y_grid) picture.line({frame.x, y}, {frame.right(), y}, {kGridColour});
    if (axes.y_ticks) picture.text({frame.x - 8.0, y + 4.0}, tick.label, {kTickSizePx, kTickColour, "end"});
  }
  picture.outline(frame, {kFrameColour});
  if (!axes.x_label.empty()) {
    picture.text({frame.x + 0.5 * frame.width, frame.bottom() + 38.0}, axes.x_label,
                 {13.0, "#1f2937", "middle"});
  }
  if (!axes.y_label.empty()) {
    picture.text({frame.x - 52.0, frame.y + 0.5 * frame.height}, axes.y_label,
                 {13.0, "#1f2937", "middle", false, -90.0});
  }
}

double legend_height(double width, const std::vector<LegendEntry>& entries) {
  return kLegendRowPx * lay_out_legend(width, entries, [](const LegendEntry&, double, int) {});
}

double draw_legend(Picture& picture, Point at, double width, const std::vector<LegendEntry>& entries) {
  const int rows = lay_out_legend(width, entries, [&](const LegendEntry& entry, double x, int row) {
    const double y = at.y + kLegendRowPx * row + 0.5 * kLegendRowPx;
    picture.line({at.x + x, y}, {at.x + x + kLegendSamplePx, y}, entry.stroke);
    picture.text({at.x + x + kLegendSamplePx + 7.0, y + 4.5}, entry.name);
  });
  return kLegendRowPx * rows;
}

Box frame_below_legend(Picture& picture, const std::vector<LegendEntry>& entries, double gap_px) {
  const double width = picture.width() - kLeftMarginPx - kRightMarginPx;
  const double top = draw_legend(picture, {kLeftMarginPx, 0.0}, width, entries) + gap_px;
  return {kLeftMarginPx, top, width, picture.height() - top - kBottomMarginPx};
}

}  // namespace isobar::report
