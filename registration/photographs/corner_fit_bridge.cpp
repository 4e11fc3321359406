#include "registration/photographs/corner_fit_bridge.h"

#include "registration/pose/marker_edges.h"
#include "registration/pose/opencv_guard.h"

#include <opencv2/aruco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace
{

/* The side of the picture in which markers are looked for: they are then some 100 pixels wide. */
constexpr double search_side_px = 1600;

/* Grey values by the square root, as a camera would; the brightest hundredth is white. */
cv::Mat exposed(const cv::Mat &linear)
{
    cv::Mat sorted = linear.clone().reshape(1, 1), grey;
    const int rank = (int)(0.99 * sorted.cols);
    float *values = sorted.ptr<float>();
    std::nth_element(values, values + rank, values + sorted.cols);
    cv::Mat root;
    cv::sqrt(cv::max(linear, 0), root);
    root.convertTo(grey, CV_8U, values[rank] > 0 ? 255 / std::sqrt((double)values[rank]) : 0);
    return grey;
}

/* Of a DICT_4X4 marker with its border. */
constexpr int cells_across = 6;

std::vector<std::vector<cv::Point2f>> find_markers(const cv::Mat &small, std::vector<int> &ids)
{
    const auto parameters = cv::aruco::DetectorParameters::create();
    parameters->adaptiveThreshWinSizeMax = 63;
    parameters->minMarkerPerimeterRate = 0.02;
    std::vector<std::vector<cv::Point2f>> corners;
    cv::aruco::detectMarkers(small, cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50), corners, ids,
                             parameters);
    return corners;
}

using points_3d = std::vector<std::vector<cv::Point3f>>;
using points_2d = std::vector<std::vector<cv::Point2f>>;

/* The plate's y goes up, as it does in Weft; OpenCV does not mind. */
void copy_points(const weft_corner_view *view, int count, points_3d &plate, points_2d &seen)
{
    for (int i = 0; i < count; i++) {
        plate.emplace_back();
        seen.emplace_back();
        for (int k = 0; k < view[i].count; k++) {
            plate.back().emplace_back((float)view[i].plate[k][0], (float)view[i].plate[k][1], 0.f);
            seen.back().emplace_back((float)view[i].seen[k][0], (float)view[i].seen[k][1]);
        }
    }
}

weft_pose pose_of(const cv::Mat &turn, const cv::Mat &shift)
{
    cv::Mat rotation;
    cv::Rodrigues(turn, rotation);
    weft_pose pose;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++)
            pose.rotation[row][column] = rotation.at<double>(row, column);
    pose.translation = {shift.at<double>(0), shift.at<double>(1), shift.at<double>(2)};
    return pose;
}

double reprojection_rms(const std::vector<cv::Point3f> &plate, const std::vector<cv::Point2f> &seen,
                        const cv::Mat &turn, const cv::Mat &shift, const cv::Mat &matrix, const cv::Mat &distortion)
{
    std::vector<cv::Point2f> predicted;
    cv::projectPoints(plate, turn, shift, matrix, distortion, predicted);
    return cv::norm(predicted, seen, cv::NORM_L2) / std::sqrt((double)seen.size());
}

int flags_of(weft_lens_knowledge knowledge)
{
    const int common =
        cv::CALIB_USE_INTRINSIC_GUESS | cv::CALIB_FIX_ASPECT_RATIO | cv::CALIB_FIX_TANGENT_DIST | cv::CALIB_FIX_K3;
    const int held = common | cv::CALIB_FIX_FOCAL_LENGTH | cv::CALIB_FIX_PRINCIPAL_POINT | cv::CALIB_FIX_K2;
    switch (knowledge) {
    case WEFT_LENS_UNKNOWN:
        return common;
    case WEFT_LENS_FOCAL_ONLY:
        return held;
    case WEFT_LENS_KNOWN:
        break;
    }
    return held | cv::CALIB_FIX_K1;
}

/* OpenCV's order: fx, fy, cx, cy, k1, k2; fx follows fy. It may leave numbers for what is held. */
weft_lens_errors errors_of(const cv::Mat &deviation, weft_lens_knowledge knowledge)
{
    const bool all = knowledge == WEFT_LENS_UNKNOWN;
    return {all ? deviation.at<double>(1) : 0, knowledge != WEFT_LENS_KNOWN ? deviation.at<double>(4) : 0,
            all ? deviation.at<double>(5) : 0};
}

weft_code fit_lens(const weft_corner_view *view, int count, weft_lens_knowledge knowledge, weft_camera *camera,
                   weft_lens_errors *errors, weft_pose *pose, double *rms_px, weft_error *error)
{
    points_3d plate;
    points_2d seen;
    copy_points(view, count, plate, seen);
    cv::Mat matrix = (cv::Mat_<double>(3, 3) << camera->fx, 0, camera->cx, 0, camera->fy, camera->cy, 0, 0, 1);
    cv::Mat distortion = (cv::Mat_<double>(1, 5) << camera->k1, camera->k2, camera->p1, camera->p2, camera->k3);
    std::vector<cv::Mat> turns, shifts;
    const cv::TermCriteria until(cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 100, 1e-10);
    cv::Mat deviation;
    const double rms =
        cv::calibrateCamera(plate, seen, cv::Size(camera->width, camera->height), matrix, distortion, turns, shifts,
                            deviation, cv::noArray(), cv::noArray(), flags_of(knowledge), until);
    if (!std::isfinite(rms))
        return weft_fail(error, WEFT_BAD_INPUT, "no lens explains the markers of %d photographs", count);
    *errors = errors_of(deviation, knowledge);
    camera->fx = matrix.at<double>(0, 0), camera->fy = matrix.at<double>(1, 1);
    camera->cx = matrix.at<double>(0, 2), camera->cy = matrix.at<double>(1, 2);
    camera->k1 = distortion.at<double>(0), camera->k2 = distortion.at<double>(1);
    for (int i = 0; i < count; i++) {
        const size_t at = (size_t)i;
        pose[i] = pose_of(turns[at], shifts[at]);
        rms_px[i] = reprojection_rms(plate[at], seen[at], turns[at], shifts[at], matrix, distortion);
    }
    return WEFT_OK;
}

} // namespace

extern "C" weft_code weft_opencv_find_markers_in_photograph(const float *grey, int width, int height,
                                                            weft_marker *marker, int *count, weft_error *error)
{
    *count = 0;
    return weft_opencv_guarded("finding markers", error, [&] {
        const cv::Mat full = exposed(cv::Mat(height, width, CV_32F, const_cast<float *>(grey)));
        const double reduction = std::max(1.0, std::max(width, height) / search_side_px);
        cv::Mat small;
        cv::resize(full, small, cv::Size(), 1 / reduction, 1 / reduction, cv::INTER_AREA);
        const double scale_x = (double)width / small.cols, scale_y = (double)height / small.rows;
        std::vector<int> ids;
        const auto corners = find_markers(small, ids);
        for (size_t found = 0; found < ids.size() && *count < WEFT_MARKERS_LIMIT; found++) {
            weft_marker *next = &marker[(*count)++];
            next->id = ids[found];
            for (size_t corner = 0; corner < 4; corner++) {
                next->corner[corner][0] = ((double)corners[found][corner].x + 0.5) * scale_x - 0.5;
                next->corner[corner][1] = ((double)corners[found][corner].y + 0.5) * scale_y - 0.5;
            }
            weft_marker_refine(full.data, width, height, cells_across, next->corner);
        }
        return WEFT_OK;
    });
}

extern "C" weft_code weft_opencv_fit_lens(const weft_corner_view *view, int count, weft_lens_knowledge knowledge,
                                          weft_camera *camera, weft_lens_errors *errors, weft_pose *pose,
                                          double *rms_px, weft_error *error)
{
    return weft_opencv_guarded("fitting a lens", error,
                               [&] { return fit_lens(view, count, knowledge, camera, errors, pose, rms_px, error); });
}
