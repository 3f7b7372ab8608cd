// SPDX-License-Identifier: BSD-3-Clause
// Height gained on moving ground (an elevator), from the vertical acceleration between two stops and the altimeter.
//
//     state (z, v, b_a, p, k):  dz/dt = v,  dv/dt = a_up - b_a,  p a random walk,  b_a and k constant
//     altimeter = z + p + k v,  v = 0 at both stops
//
// The bias b_a is the mean vertical acceleration of the rest before the ride: with the velocity known at both ends it
// is the larger part of what the integral errs by. k v is the piston effect of the cabin in its shaft, p what the ventilation
// of another floor adds. Integrated acceleration errs by 0.4 to 2.5 cm on rides of 8 m in 11 s, where the
// altimeter is off by 0.2 to 0.9 m.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

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
  /// After a gap in the acceleration: the memory is void.
  void forget();

  /// The memory is long enough to hold the start of a ride that is recognised now.
  [[nodiscard]] bool remembers_start() const;
  [[nodiscard]] bool riding() const { return riding_; }
  /// Height gained since the start of the ride, and its variance; of the last ride where none is under way.
  [[nodiscard]] double risen_m() const { return x_[kRisen]; }
  [[nodiscard]] double variance_m2() const { return P_(kRisen, kRisen); }

 private:
  enum State { kRisen, kSpeed, kAccelBias, kPressure, kPiston, kStates };
  using Vector = Eigen::Matrix<double, kStates, 1>;
  using Matrix = Eigen::Matrix<double, kStates, kStates>;

  struct Bin {
    double dt_s = 0.0;
    double speed_m_s = 0.0;     // integral of the acceleration
    double square_m2_s3 = 0.0;  // integral of its square
    double samples = 0.0;
    double altimeter_m = 0.0;
    double altimeter_weight = 0.0;  // 1 / variance; 0: no reading
    bool stands = true;
  };
  static constexpr std::size_t kBins = 200;  // 10 s

  [[nodiscard]] const Bin& back(std::size_t age) const { return bins_[(newest_ + kBins - age) % kBins]; }
  [[nodiscard]] std::size_t bins_of_ride() const;
  void learn_rest(std::size_t ride_bins);
  void predict(const Bin& bin);
  void learn_noise(const Bin& bin);
  void update(const Vector& h, double measured, double variance);
  void use(const Bin& bin);

  std::array<Bin, kBins> bins_;
  Bin open_;
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
