// SPDX-License-Identifier: BSD-3-Clause
// Height gained on moving ground (an elevator), from the vertical acceleration between two stops and the altimeter.
//
//     state (z, v, b_a, p, k, s):  dz/dt = v,  dv/dt = a_up - b_a,  p a random walk,  b_a, k and s constant
//     altimeter = (1 + s) z + p + k v,  v = 0 at both stops
//
// With the velocity known at both ends the bias b_a is the larger part of what the integral errs by; it comes from the
// rest before the ride, and from those before that. k v is the piston effect of the cabin in its shaft, p what the
// ventilation of another floor adds, s the error of the air's temperature, which stays from ride to ride. Integrated
// acceleration errs by 0.4 to 2.5 cm on rides of 8 m in 11 s, where the altimeter is off by 0.2 to 0.9 m.
//
// A ride is recognised when it is under way. Its start is looked for in the memory: the end of the last quiet.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "core/registration/rest_acceleration.hpp"

namespace isobar {

/// Keeps the last seconds before a ride, because a ride is recognised after its start. Allocates nothing.
class RideMeter {
 public:
  /// Length of one interval of the memory [s].
  static constexpr double kBinS = 0.05;

  /// Vertical acceleration over the last `dt_s`, biases included. `stands`: wheels at rest.
  void add_acceleration(double up_accel_m_s2, double dt_s, bool stands);
  /// A height from air pressure, of any zero.
  void add_altimeter(double height_m, double variance_m2);

  /// A ride has been recognised: it began within the memory, after the wheels had come to rest.
  void begin();
  /// The robot stands again.
  void end();
  /// A gap in the acceleration, of `gap_s`: the memory is void.
  void forget(double gap_s);

  /// The memory holds the start of a ride that is recognised now, and a rest before it.
  [[nodiscard]] bool remembers_start() const;
  [[nodiscard]] bool riding() const { return riding_; }
  /// In a ride: the cabin may have stopped. False while the acceleration contradicts it.
  [[nodiscard]] bool may_have_stopped() const;
  /// Height gained since the start of the ride, and its variance; of the last ride where none is under way.
  [[nodiscard]] double risen_m() const;
  [[nodiscard]] double variance_m2() const;
  /// What the altimeter gained more than risen_m(): another zone, the temperature of the air.
  [[nodiscard]] double altimeter_gain_m() const { return x_[kPressure] + x_[kScale] * x_[kRisen]; }
  /// Relative error of the altimeter's heights, learnt on rides, and its standard deviation.
  [[nodiscard]] double air_scale() const { return x_[kScale]; }
  [[nodiscard]] double air_scale_sd() const;

 private:
  enum State { kRisen, kSpeed, kAccelBias, kPressure, kPiston, kScale, kStates };
  using Vector = Eigen::Matrix<double, kStates, 1>;
  using Matrix = Eigen::Matrix<double, kStates, kStates>;

  struct Bin {
    double dt_s = 0.0;
    double speed_m_s = 0.0;     // integral of the acceleration
    double square_m2_s3 = 0.0;  // integral of its square
    double samples = 0.0;
    double altimeter_m = 0.0;
    double altimeter_weight = 0.0;  // 1 / variance; 0: no reading
    bool stands = true;             // wheels at rest, in no ride
  };
  static constexpr std::size_t kBins = 200;  // 10 s

  [[nodiscard]] const Bin& back(std::size_t age) const { return bins_[(newest_ + kBins - age) % kBins]; }
  [[nodiscard]] std::size_t rest_bins() const;
  [[nodiscard]] std::size_t bins_of_ride(std::size_t rest) const;
  [[nodiscard]] double gained_m_s(std::size_t age, std::size_t bins, double bias_m_s2) const;
  void keep(const Bin& bin);
  void take_rest(const Bin& bin);
  void learn_zero(std::size_t ride_bins, std::size_t rest);
  void predict(const Bin& bin);
  void learn_noise(const Bin& bin);
  void update(const Vector& h, double measured, double variance);
  void use(const Bin& bin);
  void use_open();

  std::array<Bin, kBins> bins_;
  Bin open_;
  RestAcceleration rest_;  // of the bins that are older than any ride that is recognised now
  std::size_t newest_ = 0;
  std::size_t count_ = 0;
  double density_ = 0.0;  // of the acceleration's noise [m^2/s^3]
  double zero_m_ = 0.0;   // altimeter at the start of the ride
  bool zero_known_ = false;
  bool riding_ = false;
  Vector x_ = Vector::Zero();
  Matrix P_ = Matrix::Zero();
};

}  // namespace isobar
