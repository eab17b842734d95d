// SPDX-License-Identifier: GPL-3.0-or-later
#include "wire.hpp"

#include "io/detail/json_text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace stylet::serve::wire {

static_assert(std::endian::native == std::endian::little, "numbers go out as they lie in memory");

namespace {

class Writer {
 public:
  Writer(Kind kind, std::uint32_t number, std::size_t room) {
    bytes_.reserve(room);
    put(static_cast<std::uint32_t>(kind));
    put(number);
  }
  template <class T>
  void put(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    append(&value, sizeof value);
  }
  template <class T>
  void put_all(std::span<const T> values) {
    static_assert(std::is_arithmetic_v<T>);
    append(values.data(), values.size_bytes());
  }
  template <class... T>
  void put_floats(T... values) {
    (put(static_cast<float>(values)), ...);
  }
  void put_counts(std::initializer_list<std::size_t> counts) {
    for (const std::size_t count : counts) put(static_cast<std::uint32_t>(count));
  }
  void text(std::string_view text) { append(text.data(), text.size()); }
  [[nodiscard]] Bytes take() { return std::move(bytes_); }

 private:
  void append(const void* data, std::size_t size) {
    const auto* from = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), from, from + size);
  }
  Bytes bytes_;
};

constexpr std::size_t kHeader = 8;

float read_float(std::span<const std::byte> message, std::size_t at) {
  float value = 0.0F;
  std::memcpy(&value, message.data() + at, sizeof value);
  return value;
}

std::optional<HandTarget> decode_hand(std::span<const std::byte> message) {
  std::array<double, 5> v{};
  if (message.size() != kHeader + 4 * v.size()) return std::nullopt;
  for (std::size_t k = 0; k < v.size(); ++k) {
    v[k] = read_float(message, kHeader + 4 * k);
    if (!std::isfinite(v[k])) return std::nullopt;
  }
  if (v[1] < 0.0) return std::nullopt;
  return HandTarget{
      .depth_mm = v[0], .speed_mm_per_s = v[1], .roll_deg = v[2], .tilt_left_deg = v[3], .tilt_anterior_deg = v[4]};
}

/// The displacement of a frame in the smallest unit in which the largest fits 8 bits.
struct CoarseDisplacement {
  double unit_mm;
  std::vector<std::int8_t> values;

  explicit CoarseDisplacement(const LiveFrame& f) : values(f.displacement.size()) {
    int most = 0;
    for (const std::int16_t u : f.displacement) most = std::max(most, std::abs(int{u}));
    const double units = std::max(1.0, most / 127.0);
    unit_mm = units * f.unit_mm;
    std::ranges::transform(f.displacement, values.begin(),
                           [units](std::int16_t u) { return static_cast<std::int8_t>(std::lround(u / units)); });
  }
};

}  // namespace

std::optional<Command> decode_command(std::string_view text) {
  const Result<nlohmann::json> parsed = detail::parse_json(text, "command");
  if (!parsed) return std::nullopt;
  const nlohmann::json& json = *parsed;
  if (!json.is_object() || !json.contains("do") || !json["do"].is_string()) return std::nullopt;
  const auto row = std::ranges::find(commands(), json["do"].get_ref<const std::string&>(), &CommandRow::word);
  if (row == commands().end()) return std::nullopt;
  Command command{row->what, {}, 0.0};
  for (const Argument& argument : row->arguments) {
    if (argument.type == Argument::Type::none) break;
    const auto value = json.find(std::string(argument.name));
    if (value == json.end()) return std::nullopt;
    if (argument.type == Argument::Type::text) {
      if (!value->is_string()) return std::nullopt;
      command.text = value->get<std::string>();
    } else {
      if (!value->is_number()) return std::nullopt;
      command.number = value->get<double>();
      if (!(std::abs(command.number) <= argument.most)) return std::nullopt;
    }
  }
  return command;
}

Bytes encode(const Scene& scene, std::uint32_t number) {
  const std::size_t padded = (scene.text.size() + 3) / 4 * 4;
  Writer out(Kind::scene, number, 20 + padded + 4 * (scene.positions.size() + scene.triangles.size()));
  out.put_counts({padded, scene.positions.size() / 3, scene.triangles.size() / 3});
  out.text(scene.text);
  out.text(std::string(padded - scene.text.size(), ' '));
  out.put_all(std::span<const float>(scene.positions));
  out.put_all(std::span<const std::uint32_t>(scene.triangles));
  return out.take();
}

Bytes encode(const LiveFrame& f, std::span<const Step> curve, bool whole_curve, std::uint32_t number, bool coarse) {
  const auto eight_bits = coarse ? std::make_optional<CoarseDisplacement>(f) : std::nullopt;
  Writer out(Kind::frame, number,
             256 + 4 * (f.centreline.size() + f.resting.size()) + 32 * f.contacts.size() + 32 * curve.size() +
                 2 * f.displacement.size());
  out.put(f.time_s);
  std::uint32_t bits = f.bits & ~static_cast<std::uint32_t>(LiveFrame::whole_curve);
  if (!f.displacement.empty()) bits |= LiveFrame::displaced;
  if (whole_curve) bits |= LiveFrame::whole_curve;
  if (coarse) bits |= LiveFrame::coarse;
  const Step& step = f.step;
  const auto tip_state = static_cast<std::uint32_t>(step.tip_state);
  const auto sticking = static_cast<std::uint32_t>(step.sticking);
  const auto iterations = static_cast<std::uint32_t>(step.iterations);
  for (const std::uint32_t value : {bits, step.flags, tip_state, sticking, iterations, f.steps, f.missed})
    out.put(value);
  out.put_floats(step.base_depth_mm, step.force_axial_N, step.force_sagittal_N, step.force_lateral_N);
  for (const Vec3& v : {step.torque_Nmm, step.tip_mm, step.base.origin}) out.put_floats(v.x(), v.y(), v.z());
  const Eigen::Quaterniond& q = step.base.rotation;
  out.put_floats(q.w(), q.x(), q.y(), q.z());
  out.put_floats(f.roll_deg, f.tilt_left_deg, f.tilt_anterior_deg, f.left_out_N,
                 eight_bits ? eight_bits->unit_mm : f.unit_mm);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const TipError tip = f.tip_error.value_or(TipError{Vec3::Constant(kNone), kNone});
  out.put_floats(tip.mm.x(), tip.mm.y(), tip.mm.z(), tip.base_depth_mm);
  out.put_counts({f.centreline.size() / 3, f.contacts.size(), curve.size(), f.displacement.size() / 3,
                  f.resting.size() / (3 * Snapshot::kRestingPoints)});
  out.put_all(std::span<const float>(f.centreline));
  out.put_all(std::span<const float>(f.resting));
  for (const ContactSnapshot& c : f.contacts) {
    out.put_floats(c.position[0], c.position[1], c.position[2], c.force[0], c.force[1], c.force[2], c.s);
    out.put((c.sticking ? 1U : 0U) | (c.tip ? 2U : 0U));
  }
  for (const Step& s : curve) {
    out.put_floats(s.time_s - f.time_s, s.base_depth_mm, s.force_axial_N, s.force_sagittal_N, s.force_lateral_N,
                   s.step_us, static_cast<int>(s.tip_state), s.flags);
  }
  if (eight_bits) {
    out.put_all(std::span<const std::int8_t>(eight_bits->values));
  } else {
    out.put_all(std::span<const std::int16_t>(f.displacement));
  }
  return out.take();
}

Bytes encode(const LiveDose& dose, std::uint32_t number) {
  Writer out(Kind::dose, number, kHeader + 32 + 2 * dose.values.size());
  for (const std::uint32_t size : dose.size) out.put(size);
  out.put_floats(dose.origin_mm.x(), dose.origin_mm.y(), dose.origin_mm.z(), dose.spacing_mm, dose.unit_percent);
  out.put_all(std::span<const std::uint16_t>(dose.values));
  return out.take();
}

Bytes encode(const LiveImage& image, std::uint32_t number) {
  Writer out(Kind::image, number, kHeader + 12 + image.text.size() + image.pixels.size());
  out.put_counts({image.text.size(), image.rows, image.columns});
  out.text(image.text);
  out.put_all(std::span<const std::uint8_t>(image.pixels));
  return out.take();
}

Bytes encode(Kind kind, std::string_view json, std::uint32_t number) {
  Writer out(kind, number, kHeader + json.size());
  out.text(json);
  return out.take();
}

std::optional<std::variant<HandTarget, Command, Seen>> decode(std::span<const std::byte> message) {
  if (message.size() < kHeader || message.size() > kLongestMessage) return std::nullopt;
  std::uint32_t kind = 0;
  std::memcpy(&kind, message.data(), sizeof kind);
  if (kind == static_cast<std::uint32_t>(Kind::hand)) {
    if (const auto hand = decode_hand(message)) return *hand;
  } else if (kind == static_cast<std::uint32_t>(Kind::command)) {
    const auto text = message.subspan(kHeader);
    if (auto command = decode_command({reinterpret_cast<const char*>(text.data()), text.size()})) return *command;
  } else if (kind == static_cast<std::uint32_t>(Kind::seen) && message.size() == kHeader + sizeof(Seen)) {
    Seen seen;
    std::memcpy(&seen, message.data() + kHeader, sizeof seen);
    return seen;
  }
  return std::nullopt;
}

void thin(std::vector<Step>& curve, std::size_t most) {
  if (curve.size() <= most) return;
  const std::size_t runs = std::max<std::size_t>(1, most / 2);
  std::vector<Step> kept;
  kept.reserve(2 * runs);
  const auto by_force = [](const Step& a, const Step& b) { return a.force_axial_N < b.force_axial_N; };
  for (std::size_t k = 0; k < runs; ++k) {
    const auto from = curve.begin() + static_cast<std::ptrdiff_t>(curve.size() * k / runs);
    const auto to = curve.begin() + static_cast<std::ptrdiff_t>(curve.size() * (k + 1) / runs);
    if (from == to) continue;
    auto [least, largest] = std::minmax_element(from, to, by_force);
    if (largest < least) std::swap(least, largest);
    kept.push_back(*least);
    if (largest != least) kept.push_back(*largest);
  }
  curve = std::move(kept);
}

}  // namespace stylet::serve::wire
