// Pictures of depth frames, with the scan made from them.
#pragma once

#include "mapper/core/camera.h"
#include "mapper/core/camera_stand.h"
#include "mapper/core/depth_image.h"
#include "mapper/core/rgb_image.h"
#include "mapper/core/scan.h"
#include "mapper/scan/scan_options.h"

namespace depthgrid {

// Near is bright, far dark, invalid pixels are grey.
RgbImage DepthPicture(const DepthImage& depth, double max_depth_m);

// The same with the scan: the pixel of each hit and, for some beams, the free stretch on the floor.
RgbImage DepthPictureWithBeams(const DepthImage& depth, const PinholeCamera& camera,
                               const CameraStand& stand, const Scan& scan,
                               const ScanOptions& options);

}  // namespace depthgrid
