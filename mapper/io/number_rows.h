// Splitting and number syntax of text files with columns (trajectories, matrices).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace depthgrid {

struct TextRow {
  int line = 0;  // from 1
  std::vector<std::string_view> fields;
};

// Removes the byte order mark with which Windows programs begin UTF-8 text.
std::string_view WithoutByteOrderMark(std::string_view text);

// The lines of `text` that are neither empty nor `#` comments, split at spaces, tabs and commas.
// Windows line ends and a byte order mark are ignored. The views point into `text`.
std::vector<TextRow> SplitRows(std::string_view text);
std::vector<TextRow> SplitRows(std::string&& text) = delete;  // the rows are views of it

// The fields of one line of CSV, empty ones included.
std::vector<std::string_view> SplitAtCommas(std::string_view line);

// A decimal number whatever the locale; "nan" and "inf" are numbers. Nothing when the field is not
// entirely a number.
std::optional<double> ParseNumber(std::string_view field);

// True for 010, which some programs read as 8 and others as 10; false for 0 and 0.5.
bool HasLeadingZero(std::string_view number);

// "file:12", the place of a row in errors.
std::string PlaceOfLine(const std::string& path, int line);

// The text of the line from field number `field` (from 0) on: for file names with spaces.
std::string_view RestOf(const TextRow& row, std::size_t field);

// Throws InputError for a row with zero bytes: UTF-16, as redirected by a Windows shell.
void RequireText(const TextRow& row, const std::string& path);

// Throws InputError for semicolons between columns or decimal commas, as from spreadsheets in some
// languages; otherwise each row would only be counted as damaged.
void RequirePlainColumns(const std::vector<TextRow>& rows, const std::string& path);

// All fields of a row as numbers; throws InputError unless there are exactly `count`.
std::vector<double> NumbersIn(const TextRow& row, std::size_t count, const std::string& path);

// Stamps are in seconds; milliseconds or nanoseconds since 1970 are beyond this (year 5138).
constexpr double kLatestStampS = 1e11;
// Units per second of a number that may be a time since 1970: milliseconds from kLatestStampS on,
// microseconds from 1e15 and nanoseconds from 1e17 on (unambiguous from 1973 to 5138); below, 1.
double StampUnitsASecond(double number);
// Throws InputError unless it is a finite number of seconds.
void RequireSeconds(double stamp_s, const std::string& place);

// Whether both are equal when written with six decimals.
bool IsSameStamp(double a_s, double b_s);

// The error message for a position that is not finite or out of range (IsWithinReach).
std::string PositionBeyondReach(const Eigen::Vector3d& position_m, const std::string& place);

// How far the norm of a unit quaternion may be off. Files print four to nine digits, so norms are
// off by up to 1e-4; a larger error is a column mistaken for another.
constexpr double kMaxNormError = 0.05;
// Closer than this the quaternion is kept bit for bit (nine printed digits of a float pose), so
// that an unchanged pose is printed unchanged.
constexpr double kExactNormError = 1e-6;

}  // namespace depthgrid
