#include "mapper/io/carmen_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "mapper/core/error.h"
#include "mapper/core/frame.h"
#include "mapper/core/scan.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {
namespace {

constexpr int kMaxReadings = 20000;
// Columns after the host: the logger's time, and additions of some loggers.
constexpr int kMostLastColumns = 8;
constexpr double kMaxYawRad = 1e6;  // beyond is a damaged number
constexpr std::string_view kDamagedPose = "with a damaged pose (no numbers, or beyond 10,000 km)";
constexpr double kMaxFieldOfViewRad = 2.0 * kPi + 1e-6;

// A field for error messages; "missing" at the end of a line.
std::string Shown(std::string_view token) {
  constexpr std::size_t kMostShown = 40;
  return token.empty() ? "missing" : fmt::format("'{}'", token.substr(0, kMostShown));
}

class Tokens {
 public:
  explicit Tokens(std::string_view text) : rest_(text) {}

  std::string_view Next() {
    // Plain loops: tokens are a few characters, for which find_first_of takes three times as long.
    std::size_t begin = 0;
    while (begin < rest_.size() && IsBlank(rest_[begin])) ++begin;
    std::size_t end = begin;
    while (end < rest_.size() && !IsBlank(rest_[end])) ++end;
    const std::string_view token = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return token;
  }

  std::optional<double> NextNumber() { return ParseNumber(Next()); }

 private:
  static bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

  std::string_view rest_;
};

bool IsMessageName(std::string_view word) {
  // Not of a number alone, such as the whole stamp of a trajectory.
  const auto is_letter = [](char c) { return c >= 'A' && c <= 'Z'; };
  return std::any_of(word.begin(), word.end(), is_letter) &&
         std::all_of(word.begin(), word.end(),
                     [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

CarmenDamage Damage(std::string_view message, std::string_view what, std::string fault = {}) {
  return {fmt::format("{} {}", message, what), true, std::move(fault)};
}

struct NumberList {
  std::vector<double> values;
  std::string fault;  // empty when it is valid
};

// Reads a count and as many numbers.
NumberList ReadList(Tokens& tokens, int minimum) {
  const std::string_view stated = tokens.Next();
  const std::optional<double> count = ParseNumber(stated);
  if (!count || !(*count >= minimum && *count <= kMaxReadings) || *count != std::floor(*count)) {
    return {{},
            fmt::format("their count is {}, must be a whole number from {} to {}", Shown(stated),
                        minimum, kMaxReadings)};
  }
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(*count));
  for (int i = 0; i < static_cast<int>(*count); ++i) {
    const std::string_view token = tokens.Next();
    const std::optional<double> value = ParseNumber(token);
    if (!value) {
      return {{},
              fmt::format("number {} of {} is {}, must be a number", i + 1, *count, Shown(token))};
    }
    values.push_back(*value);
  }
  return {std::move(values), {}};
}

struct StatedPose {
  Pose2 pose;
  double yaw_rad = 0.0;  // as written
};

std::optional<StatedPose> ReadPose(Tokens& tokens) {
  const std::optional<double> x_m = tokens.NextNumber();
  const std::optional<double> y_m = tokens.NextNumber();
  const std::optional<double> yaw_rad = tokens.NextNumber();
  // False for NaN too.
  const auto sane = [](const std::optional<double>& v, double most) {
    return v && std::abs(*v) <= most;
  };
  if (!sane(x_m, kFarthestPoseM) || !sane(y_m, kFarthestPoseM) || !sane(yaw_rad, kMaxYawRad)) {
    return std::nullopt;
  }
  return StatedPose{{*x_m, *y_m, WrapAngle(*yaw_rad)}, *yaw_rad};
}

// Reads the end of a scan's line: `skip` numbers, the time, the host and the logger's time. Returns
// the damage, if any.
std::optional<CarmenDamage> ReadEnd(Tokens& tokens, std::string_view name, int skip,
                                    double& end_stamp_s) {
  constexpr std::string_view kNoTime = "without a time";
  for (int i = 0; i < skip; ++i) {
    const std::string_view token = tokens.Next();
    if (ParseNumber(token)) continue;
    return Damage(name, kNoTime,
                  fmt::format("number {} of {} before it is {}, must be a number", i + 1, skip,
                              Shown(token)));
  }
  const std::string_view time = tokens.Next();
  const std::optional<double> stamp_s = ParseNumber(time);
  if (!stamp_s || !std::isfinite(*stamp_s)) {
    return Damage(name, kNoTime, fmt::format("it is {}, must be a number of seconds", Shown(time)));
  }
  if (std::abs(*stamp_s) > kLatestStampS) {
    return Damage(name, "with a time that is not in seconds",
                  fmt::format("it is {}, must be at most {:g}", Shown(time), kLatestStampS));
  }
  // Without a host after it, the time itself may be truncated.
  const std::string_view host = tokens.Next();
  if (host.empty()) {
    return Damage(name, kNoTime,
                  fmt::format("the line ends with {}, must go on with the host", Shown(time)));
  }
  // If a line has more readings than stated, the columns are shifted and the time is in the host's
  // place. Some hosts are numbers, but then only the logger's time follows.
  const bool is_number = ParseNumber(host).has_value();
  for (int i = 0;; ++i) {
    const std::string_view token = tokens.Next();
    if (token.empty()) break;
    if (is_number && (i > 0 || !ParseNumber(token))) {
      return Damage(name, "with other columns than its count of readings says");
    }
    if (i == kMostLastColumns) {
      return Damage(name, "with more columns than it states (a lost line end?)");
    }
  }
  end_stamp_s = *stamp_s;
  return {};
}

// FLASER n ranges.. laser_x y theta robot_x y theta time host logger_time. The format states no
// angles: it is the SICK's half circle, 1 degree apart for 180 and 181 readings, 0.5 for 360, 361.
CarmenLine ParseFlaser(Tokens& tokens) {
  CarmenScan scan;
  NumberList ranges = ReadList(tokens, 2);
  if (!ranges.fault.empty()) return Damage("FLASER", "with damaged readings", ranges.fault);
  scan.range_m = std::move(ranges.values);
  scan.states_angles = false;
  const auto n = static_cast<double>(scan.range_m.size());
  scan.first_bearing_rad = -kPi / 2.0;
  scan.bearing_step_rad = kPi / (scan.range_m.size() % 2 == 0 ? n : n - 1.0);
  const auto laser = ReadPose(tokens);
  const auto robot = ReadPose(tokens);
  if (!laser || !robot) return Damage("FLASER", kDamagedPose);
  scan.odom_from_laser = laser->pose;
  scan.odom_from_robot = robot->pose;
  scan.stated_yaw_rad = laser->yaw_rad;
  if (auto damage = ReadEnd(tokens, "FLASER", 0, scan.stamp_s)) return *damage;
  return scan;
}

// The fault of a ROBOTLASER1 header's angles; empty if they are possible.
std::string FaultOfAngles(double first_rad, double fov_rad, double resolution_rad,
                          std::size_t readings) {
  const auto steps = static_cast<double>(readings - 1);
  if (resolution_rad < 0.0) {
    return fmt::format("the resolution is {:g}, must be above 0", resolution_rad);
  }
  if (resolution_rad == 0.0 && !(fov_rad > 0.0)) {
    return fmt::format("the field of view is {:g} and the resolution 0, one must be above 0",
                       fov_rad);
  }
  if (resolution_rad > 0.0 && resolution_rad * steps > kMaxFieldOfViewRad) {
    return fmt::format(
        "the resolution is {:g}, must be at most {:.4g} (radians) for {} readings: a whole turn",
        resolution_rad, kMaxFieldOfViewRad / steps, readings);
  }
  if (resolution_rad == 0.0 && fov_rad > kMaxFieldOfViewRad) {
    return fmt::format("the field of view is {:g}, must be at most {:.4g} (radians)", fov_rad,
                       kMaxFieldOfViewRad);
  }
  if (std::abs(first_rad) > kMaxFieldOfViewRad) {
    return fmt::format("the start angle is {:g}, must be from {:.4g} to {:.4g} (radians)",
                       first_rad, -kMaxFieldOfViewRad, kMaxFieldOfViewRad);
  }
  return {};
}

// type start fov resolution max accuracy remission_mode n ranges.. m remissions.. Returns the
// damage, if any.
std::optional<CarmenDamage> ReadAngledReadings(Tokens& tokens, std::string_view name,
                                               CarmenScan& scan) {
  constexpr const char* kFields[] = {"type",    "start angle", "field of view", "resolution",
                                     "maximum", "accuracy",    "remission mode"};
  double header[std::size(kFields)];
  for (std::size_t i = 0; i < std::size(kFields); ++i) {
    const std::string_view token = tokens.Next();
    const std::optional<double> number = ParseNumber(token);
    if (!number || !std::isfinite(*number)) {
      return Damage(name, "with a damaged header",
                    fmt::format("the {} is {}, must be a number", kFields[i], Shown(token)));
    }
    header[i] = *number;
  }
  NumberList ranges = ReadList(tokens, 2);
  if (!ranges.fault.empty()) return Damage(name, "with damaged readings", ranges.fault);
  scan.range_m = std::move(ranges.values);
  const auto steps = static_cast<double>(scan.range_m.size() - 1);
  scan.first_bearing_rad = header[1];
  scan.stated_fov_rad = header[2];
  scan.bearing_step_rad = header[3] > 0.0 ? header[3] : header[2] / steps;
  if (std::string fault = FaultOfAngles(header[1], header[2], header[3], scan.range_m.size());
      !fault.empty()) {
    return Damage(name, "with impossible angles", std::move(fault));
  }
  scan.max_range_m = std::max(header[4], 0.0);
  if (const NumberList remissions = ReadList(tokens, 0); !remissions.fault.empty()) {
    return Damage(name, "with damaged remissions", remissions.fault);
  }
  return {};
}

// ROBOTLASER1 readings laser_x y theta robot_x y theta tv rv forward side turn time host
// logger_time.
CarmenLine ParseRobotLaser(Tokens& tokens) {
  constexpr std::string_view kName = "ROBOTLASER1";
  CarmenScan scan;
  if (auto damage = ReadAngledReadings(tokens, kName, scan)) return *damage;
  const auto laser = ReadPose(tokens);
  const auto robot = ReadPose(tokens);
  if (!laser || !robot) return Damage(kName, kDamagedPose);
  scan.odom_from_laser = laser->pose;
  scan.odom_from_robot = robot->pose;
  scan.stated_yaw_rad = laser->yaw_rad;
  if (auto damage = ReadEnd(tokens, kName, 5, scan.stamp_s)) return *damage;
  return scan;
}

CarmenDamage OfRawScan(CarmenDamage damage) {
  damage.is_scan = true;
  damage.is_raw = true;
  return damage;
}

CarmenDamage OfOdometry(CarmenDamage damage) {
  damage.is_scan = false;
  damage.is_raw = true;
  return damage;
}

// RAWLASER1 readings time host logger_time.
CarmenLine ParseRawLaser(Tokens& tokens) {
  constexpr std::string_view kName = "RAWLASER1";
  CarmenRawScan raw;
  auto damage = ReadAngledReadings(tokens, kName, raw.scan);
  if (!damage) damage = ReadEnd(tokens, kName, 0, raw.scan.stamp_s);
  if (damage) return OfRawScan(std::move(*damage));
  return raw;
}

// ODOM x y theta tv rv accel time host logger_time.
CarmenLine ParseOdometry(Tokens& tokens) {
  constexpr std::string_view kName = "ODOM";
  CarmenOdometry odometry;
  const auto robot = ReadPose(tokens);
  if (!robot) return OfOdometry(Damage(kName, kDamagedPose));
  odometry.odom_from_robot = robot->pose;
  if (auto damage = ReadEnd(tokens, kName, 3, odometry.stamp_s)) {
    return OfOdometry(std::move(*damage));
  }
  return odometry;
}

std::optional<CarmenOffset::Of> OffsetNamed(std::string_view parameter) {
  if (parameter == "robot_frontlaser_offset") return CarmenOffset::Of::kX;
  if (parameter == "robot_frontlaser_side_offset") return CarmenOffset::Of::kY;
  if (parameter == "robot_frontlaser_angular_offset") return CarmenOffset::Of::kYaw;
  return {};
}

// What no laser's place on a robot can be: millimetres, degrees.
CarmenLine OffsetOf(CarmenOffset::Of of, std::string_view name, std::optional<double> value) {
  constexpr double kFarthestM = 10.0;
  constexpr double kMostRad = 2.0 * kPi;
  const bool is_yaw = of == CarmenOffset::Of::kYaw;
  const double most = is_yaw ? kMostRad : kFarthestM;
  if (value && std::abs(*value) <= most) return CarmenOffset{of, *value};
  const std::string given = value ? fmt::format("{:g}", *value) : "no number";
  return CarmenDamage{
      "a damaged PARAM of the front laser's place", false,
      fmt::format("{} is {}, must be {} at most", name, given, is_yaw ? "two pi radians" : "10 m"),
      true};
}

// PARAM name value time host logger_time. The front laser is the one of all three.
CarmenLine ParseParameter(Tokens& tokens) {
  const std::string_view name = tokens.Next();
  const std::optional<double> value = tokens.NextNumber();
  if (const auto offset = OffsetNamed(name)) return OffsetOf(*offset, name, value);
  const bool is_maximum = name == "robot_front_laser_max" && value && *value > 0.0;
  if (!is_maximum || !std::isfinite(*value)) return CarmenOther{};
  return CarmenMaximum{*value};
}

// Readings in millimetres would all be taken for no return.
void RequireMetres(const std::vector<double>& range_m) {
  // Chosen, not measured.
  constexpr double kBeyondAnyM = 100.0;
  constexpr double kCodesRatio = 1.05;  // codes for no return are nearer to each other
  constexpr int kFewest = 20;
  double least_m = std::numeric_limits<double>::infinity(), most_m = 0.0;
  int readings = 0;
  for (const double reading_m : range_m) {
    if (!(reading_m > 0.0) || !std::isfinite(reading_m)) continue;
    if (reading_m < kBeyondAnyM) return;
    least_m = std::min(least_m, reading_m);
    most_m = std::max(most_m, reading_m);
    ++readings;
  }
  if (readings < kFewest || most_m <= kUsualReachM || most_m < kCodesRatio * least_m) return;
  throw InputError("range_m", fmt::format("is {:g} to {:g}, must be metres: are these millimetres?",
                                          least_m, most_m));
}

}  // namespace

CarmenLine ParseCarmenLine(std::string_view line) {
  Tokens tokens(line);
  const std::string_view name = tokens.Next();
  if (name.empty() || name.front() == '#') return CarmenOther{};
  if (name == "FLASER") return ParseFlaser(tokens);
  if (name == "ROBOTLASER1") return ParseRobotLaser(tokens);
  if (name == "RAWLASER1") return ParseRawLaser(tokens);
  if (name == "ODOM") return ParseOdometry(tokens);
  if (name == "PARAM") return ParseParameter(tokens);
  if (IsMessageName(name)) return CarmenOther{};
  return CarmenDamage{kNamelessLine, false};
}

void RequireSound(const CarmenScan& scan) {
  const auto require = [](bool holds, const char* field, double value, const char* rule) {
    if (!holds) throw InputError(field, fmt::format("is {:g}, {}", value, rule));
  };
  require(std::isfinite(scan.first_bearing_rad), "first_bearing_rad", scan.first_bearing_rad,
          "must be finite");
  require(std::isfinite(scan.bearing_step_rad), "bearing_step_rad", scan.bearing_step_rad,
          "must be finite");
  const double end_rad =
      scan.first_bearing_rad + scan.bearing_step_rad * static_cast<double>(scan.range_m.size());
  for (const double bearing_rad : {scan.first_bearing_rad, end_rad}) {
    require(std::abs(bearing_rad) <= kFarthestBearingRad, "bearing", bearing_rad,
            "must be radians within two turns: are these degrees?");
  }
  require(scan.bearing_step_rad != 0.0 || scan.range_m.size() < 2 || !scan.states_angles,
          "bearing_step_rad", scan.bearing_step_rad, "must not be, of more than one reading");
  require(scan.max_range_m >= 0.0, "max_range_m", scan.max_range_m, "must be 0 or more");
  RequireMetres(scan.range_m);
}

void RequireFieldOfView(double fov_deg) {
  if (fov_deg == 0.0 || fov_deg >= 1.0) return;
  throw SettingError("sequence.laser.fov_deg",
                     fmt::format("is {:g}, must be 0 or from 1 to 360", fov_deg));
}

}  // namespace depthgrid
