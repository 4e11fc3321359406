/* OpenCV's lens, to hold ours against. A lens is fx, fy, cx, cy, k1, k2, p1, p2, k3. */
#ifndef WEFT_TESTS_BTF_LENS_BRIDGE_H
#define WEFT_TESTS_BTF_LENS_BRIDGE_H

#ifdef __cplusplus
extern "C" {
#endif

/* cv::projectPoints of the point (x, y, 1) in front of the camera. */
void opencv_project(const double lens[9], double x, double y, double pixel[2]);

/* cv::undistortPoints, iterated to 1e-12, as an undistorted pixel. */
void opencv_undistort(const double lens[9], const double distorted[2], double pixel[2]);

#ifdef __cplusplus
}
#endif
#endif
