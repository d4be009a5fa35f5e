// Values of camera files of other programs (camera_formats.h), with errors that name the key.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mapper/core/camera.h"
#include "mapper/io/config.h"

namespace depthgrid {

// The keys of a file of another program; OpenCV begins its own with a directive that YAML 1.2 does
// not know.
Config ConfigOfOthers(const std::string& text, const std::string& place);
// Whether a text holds rows of numbers rather than keys.
bool BeginsWithNumber(const std::string& text);

// A finite number, or finite numbers, at a key path.
double NumberAt(const Config& config, const std::string& key);
std::vector<double> NumbersAt(const Config& config, const std::string& key);
// The finite numbers of a list's elements; `key` and `place` name it.
std::vector<double> NumbersOf(const std::vector<std::string>& items, const std::string& key,
                              const std::string& place);
// A whole number of pixels.
int WholeAt(const Config& config, const std::string& key);
int PixelsOf(double number, std::string_view key, const std::string& place);
// The first of several alternative keys that is present; empty when there is none.
std::string FirstOf(const Config& config, const std::vector<std::string>& keys);
// The same; throws InputError when there is none.
std::string NeededOf(const Config& config, const std::vector<std::string>& keys);

// Three or four rows of `columns` numbers, [fx 0 cx; 0 fy cy; 0 0 1].
void SetMatrix(const std::vector<double>& row_major, std::size_t columns, const std::string& place,
               PinholeCamera& camera);
// k1 k2 p1 p2 k3 and zeros.
void SetDistortion(const std::vector<double>& coefficients, const std::string& place,
                   PinholeCamera& camera);

}  // namespace depthgrid
