// Camera files and bin files (JSON, millimetres).
//
// Camera:  {"cam_K": [fx, 0, cx, 0, fy, cy, 0, 0, 1], "depth_scale": 0.1, "width": 640, "height":
// 480}
//          or the same with "fx", "fy", "cx", "cy" in place of "cam_K" (BOP's camera.json)
// Scan:    {"orthographic": true, "pixel_size": 0.5, "depth_scale": 1.0, "width": 640, "height":
// 480}
//          with "cam_K" or "cx" and "cy" where the centre is not that of the image
//          Both may state the standard deviation of a depth, "error_mm"; else it is measured.
// Bin:     {"cam_R_bin2c": [9 numbers, row by row], "cam_t_bin2c": [3], "inner_size": [x, y,
// height]}
#pragma once

#include <filesystem>
#include <string>

#include "core/camera.h"

namespace rangepose {

/// Largest number of pixels of a depth image.
inline constexpr int kMaxImagePixels = 64'000'000;

/// depth_scale is 1 where it is missing. width and height may be missing together: they are 0 then,
/// and so is the centre of an orthographic scan not known yet (NaN); withImageSize() settles both.
/// Errors name the file and the field: no skew, no singular matrix, last row 0 0 1.
Camera readCamera(const std::filesystem::path& path);

/// As readCamera; `where` names the source of the text in messages.
Camera parseCamera(const std::string& json_text, const std::string& where);

/// The camera with the size of its image. Throws Error naming `where` when the camera file says
/// another size, and whatever Camera::check() finds.
Camera withImageSize(const Camera& camera, int width, int height, const std::string& where);

/// Throws Error when the matrix is not a rotation or a side is not positive.
BinBox readBinBox(const std::filesystem::path& path);

/// As readBinBox; `where` names the source of the text in messages.
BinBox parseBinBox(const std::string& json_text, const std::string& where);

}  // namespace rangepose
