#include "registration/pose/opencv_bridge.h"

#include "registration/pose/marker_edges.h"
#include "registration/pose/opencv_guard.h"

#include <opencv2/aruco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace
{

using points = std::vector<cv::Point2f>;

cv::Mat wrap(const uint8_t *grey, int width, int height)
{
    return cv::Mat(height, width, CV_8U, const_cast<uint8_t *>(grey));
}

/* ---- Markers ---- */

/* In the order of OpenCV's numbers. */
constexpr const char *dictionaries[] = {
    "4X4_50",   "4X4_100",  "4X4_250",        "4X4_1000",      "5X5_50",        "5X5_100",        "5X5_250",
    "5X5_1000", "6X6_50",   "6X6_100",        "6X6_250",       "6X6_1000",      "7X7_50",         "7X7_100",
    "7X7_250",  "7X7_1000", "ARUCO_ORIGINAL", "APRILTAG_16h5", "APRILTAG_25h9", "APRILTAG_36h10", "APRILTAG_36h11",
};

/* Null where there is none of that name. */
cv::Ptr<cv::aruco::Dictionary> dictionary_of(const char *name)
{
    for (size_t i = 0; i < std::size(dictionaries); i++)
        if (strcasecmp(dictionaries[i], name) == 0)
            return cv::aruco::getPredefinedDictionary((int)i);
    return {};
}

/* Markers of `small`, whose pixels are `reduction` of those of `full`, in which their edges are found. */
int find_markers(const cv::Ptr<cv::aruco::Dictionary> &dictionary,
                 const cv::Ptr<cv::aruco::DetectorParameters> &parameters, const cv::Mat &small, const cv::Mat &full,
                 weft_marker *marker, int limit)
{
    const double scale[2] = {(double)full.cols / small.cols, (double)full.rows / small.rows};
    std::vector<points> corners;
    std::vector<int> ids;
    cv::aruco::detectMarkers(small, dictionary, corners, ids, parameters);
    int count = 0;
    for (size_t found = 0; found < ids.size() && count < limit; found++) {
        weft_marker *next = &marker[count++];
        next->id = ids[found];
        for (size_t corner = 0; corner < 4; corner++) {
            next->corner[corner][0] = ((double)corners[found][corner].x + 0.5) * scale[0] - 0.5;
            next->corner[corner][1] = ((double)corners[found][corner].y + 0.5) * scale[1] - 0.5;
        }
        weft_marker_refine(full.data, full.cols, full.rows, dictionary->markerSize + 2, next->corner);
    }
    return count;
}

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

/* ---- Chessboard ---- */

/* Large photographs are searched at a size at which squares are no larger than the search expects. */
bool find_chessboard(const cv::Mat &picture, const cv::Size &size, points *corners)
{
    constexpr int longest = 1600;
    double scale = std::min(1.0, double(longest) / std::max(picture.cols, picture.rows));
    cv::Mat small = picture;
    if (scale < 1)
        cv::resize(picture, small, cv::Size(), scale, scale, cv::INTER_AREA);
    bool found = cv::findChessboardCorners(small, size, *corners,
                                           cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE |
                                               cv::CALIB_CB_FAST_CHECK) ||
                 cv::findChessboardCornersSB(small, size, *corners, cv::CALIB_CB_EXHAUSTIVE | cv::CALIB_CB_ACCURACY);
    for (cv::Point2f &corner : *corners)
        corner = cv::Point2f(float((corner.x + 0.5) / scale - 0.5), float((corner.y + 0.5) / scale - 0.5));
    return found && corners->size() == size_t(size.area());
}

void store(const points &corners, double (*corner)[2])
{
    for (size_t i = 0; i < corners.size(); i++) {
        corner[i][0] = corners[i].x;
        corner[i][1] = corners[i].y;
    }
}

/* ---- Calibration ---- */

weft_pose pose_of(const cv::Mat &turn, const cv::Mat &shift)
{
    cv::Mat rotation;
    cv::Rodrigues(turn, rotation);
    weft_pose pose;
    std::copy_n(rotation.ptr<double>(), 9, &pose.rotation[0][0]);
    pose.translation = {shift.at<double>(0), shift.at<double>(1), shift.at<double>(2)};
    return pose;
}

int flags_of(unsigned fixed, bool from_camera)
{
    int flags = from_camera ? cv::CALIB_USE_INTRINSIC_GUESS | cv::CALIB_FIX_ASPECT_RATIO : 0;
    flags |= fixed & WEFT_FIX_FOCAL_LENGTH ? cv::CALIB_FIX_FOCAL_LENGTH : 0;
    flags |= fixed & WEFT_FIX_MIDDLE ? cv::CALIB_FIX_PRINCIPAL_POINT : 0;
    flags |= fixed & WEFT_FIX_K1 ? cv::CALIB_FIX_K1 : 0;
    flags |= fixed & WEFT_FIX_K2 ? cv::CALIB_FIX_K2 : 0;
    flags |= fixed & WEFT_FIX_TANGENTIAL ? cv::CALIB_FIX_TANGENT_DIST : 0;
    return flags | (fixed & WEFT_FIX_K3 ? cv::CALIB_FIX_K3 : 0);
}

/* OpenCV may leave numbers for what is fixed. */
void store_errors(const cv::Mat &deviation, unsigned fixed, double standard_error[WEFT_LENS_PARAMETERS])
{
    const unsigned term[WEFT_LENS_PARAMETERS] = {WEFT_FIX_FOCAL_LENGTH, WEFT_FIX_FOCAL_LENGTH, WEFT_FIX_MIDDLE,
                                                 WEFT_FIX_MIDDLE,       WEFT_FIX_K1,           WEFT_FIX_K2,
                                                 WEFT_FIX_TANGENTIAL,   WEFT_FIX_TANGENTIAL,   WEFT_FIX_K3};
    for (int i = 0; i < WEFT_LENS_PARAMETERS; i++)
        standard_error[i] = fixed & term[i] ? 0 : deviation.at<double>(i);
}

weft_code calibrate(const weft_corner_view *view, int count, unsigned fixed, bool from_camera, weft_camera *camera,
                    weft_corner_fit *fit, weft_error *error)
{
    std::vector<std::vector<cv::Point3f>> plate((size_t)count);
    std::vector<points> seen((size_t)count);
    for (size_t i = 0; i < seen.size(); i++) {
        for (int k = 0; k < view[i].count; k++) {
            plate[i].emplace_back((float)view[i].plate[k][0], (float)view[i].plate[k][1], 0.f);
            seen[i].emplace_back((float)view[i].seen[k][0], (float)view[i].seen[k][1]);
        }
    }
    cv::Mat matrix, distortion, deviation, view_errors;
    if (from_camera) {
        matrix = (cv::Mat_<double>(3, 3) << camera->fx, 0, camera->cx, 0, camera->fy, camera->cy, 0, 0, 1);
        distortion = (cv::Mat_<double>(1, 5) << camera->k1, camera->k2, camera->p1, camera->p2, camera->k3);
    }
    std::vector<cv::Mat> turns, shifts;
    const cv::TermCriteria until(cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 100, 1e-12);
    fit->rms_px =
        cv::calibrateCamera(plate, seen, cv::Size(camera->width, camera->height), matrix, distortion, turns, shifts,
                            deviation, cv::noArray(), view_errors, flags_of(fixed, from_camera), until);
    const double focal[2] = {matrix.at<double>(0, 0), matrix.at<double>(1, 1)};
    if (!std::isfinite(fit->rms_px) || !(focal[0] > 0) || !(focal[1] > 0) || !cv::checkRange(matrix) ||
        !cv::checkRange(distortion))
        return weft_fail(error, WEFT_BAD_INPUT, "no lens fits the corners of %d photographs", count);
    store_errors(deviation, fixed, fit->standard_error);
    camera->fx = focal[0], camera->fy = focal[1];
    camera->cx = matrix.at<double>(0, 2), camera->cy = matrix.at<double>(1, 2);
    camera->k1 = distortion.at<double>(0), camera->k2 = distortion.at<double>(1);
    camera->p1 = distortion.at<double>(2), camera->p2 = distortion.at<double>(3), camera->k3 = distortion.at<double>(4);
    size_t at = 0;
    for (size_t i = 0; i < seen.size(); i++) {
        fit->pose[i] = pose_of(turns[i], shifts[i]);
        if (fit->view_rms_px)
            fit->view_rms_px[i] = view_errors.at<double>((int)i);
        points projected;
        if (fit->residual_px)
            cv::projectPoints(plate[i], turns[i], shifts[i], matrix, distortion, projected);
        for (size_t k = 0; k < projected.size(); k++, at++) {
            fit->residual_px[at][0] = seen[i][k].x - projected[k].x;
            fit->residual_px[at][1] = seen[i][k].y - projected[k].y;
        }
    }
    return WEFT_OK;
}

} // namespace

extern "C" int weft_marker_dictionary_size(const char *dictionary)
{
    const auto found = dictionary_of(dictionary);
    return found ? found->bytesList.rows : 0;
}

extern "C" weft_code weft_opencv_find_markers(const char *dictionary, const uint8_t *grey, int width, int height,
                                              weft_marker *marker, int limit, int *count, weft_error *error)
{
    *count = 0;
    return weft_opencv_guarded("finding markers", error, [&] {
        const auto found = dictionary_of(dictionary ? dictionary : dictionaries[0]);
        const auto parameters = cv::aruco::DetectorParameters::create();
        if (!found)
            return weft_fail(error, WEFT_BAD_USAGE, "there is no dictionary '%s' of markers", dictionary);
        parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
        const cv::Mat picture = wrap(grey, width, height);
        *count = find_markers(found, parameters, picture, picture, marker, limit);
        return WEFT_OK;
    });
}

extern "C" weft_code weft_opencv_find_markers_in_photograph(const float *grey, int width, int height,
                                                            weft_marker *marker, int limit, int *count,
                                                            weft_error *error)
{
    /* Markers are then some 100 pixels wide. */
    constexpr double search_side_px = 1600;
    *count = 0;
    return weft_opencv_guarded("finding markers", error, [&] {
        const cv::Mat full = exposed(cv::Mat(height, width, CV_32F, const_cast<float *>(grey)));
        const double reduction = std::max(1.0, std::max(width, height) / search_side_px);
        cv::Mat small;
        cv::resize(full, small, cv::Size(), 1 / reduction, 1 / reduction, cv::INTER_AREA);
        const auto parameters = cv::aruco::DetectorParameters::create();
        parameters->adaptiveThreshWinSizeMax = 63;
        parameters->minMarkerPerimeterRate = 0.02;
        *count = find_markers(dictionary_of(dictionaries[0]), parameters, small, full, marker, limit);
        return WEFT_OK;
    });
}

extern "C" weft_code weft_opencv_find_chessboard(const uint8_t *grey, int width, int height, int columns, int rows,
                                                 double (*corner)[2], bool *found, weft_error *error)
{
    *found = false;
    return weft_opencv_guarded("finding a chessboard", error, [&] {
        points corners;
        *found = find_chessboard(wrap(grey, width, height), cv::Size(columns, rows), &corners);
        if (*found)
            store(corners, corner);
        return WEFT_OK;
    });
}

extern "C" weft_code weft_opencv_refine_corners(const uint8_t *grey, int width, int height, double (*corner)[2],
                                                int count, int reach, weft_error *error)
{
    return weft_opencv_guarded("refining corners", error, [&] {
        points corners;
        for (int i = 0; i < count; i++)
            corners.emplace_back(float(corner[i][0]), float(corner[i][1]));
        if (count > 0)
            cv::cornerSubPix(wrap(grey, width, height), corners, cv::Size(reach, reach), cv::Size(-1, -1),
                             cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-3));
        store(corners, corner);
        return WEFT_OK;
    });
}

extern "C" weft_code weft_opencv_fit_homography(const double (*from)[2], const double (*to)[2], int count, double reach,
                                                double homography[3][3], uint8_t *agrees, weft_error *error)
{
    return weft_opencv_guarded("fitting a homography", error, [&] {
        const cv::Mat source(count, 1, CV_64FC2, const_cast<double(*)[2]>(from));
        const cv::Mat target(count, 1, CV_64FC2, const_cast<double(*)[2]>(to));
        cv::Mat mask;
        cv::theRNG().state = 1;
        const cv::Mat found = cv::findHomography(source, target, cv::RANSAC, reach, mask);
        if (found.empty())
            return weft_fail(error, WEFT_BAD_INPUT, "no homography fits %d points", count);
        std::copy_n(found.ptr<double>(), 9, &homography[0][0]);
        std::copy_n(mask.ptr<uint8_t>(), count, agrees);
        return WEFT_OK;
    });
}

extern "C" weft_code weft_opencv_calibrate(const weft_corner_view *view, int count, unsigned fixed, bool from_camera,
                                           weft_camera *camera, weft_corner_fit *fit, weft_error *error)
{
    return weft_opencv_guarded("fitting a lens", error,
                               [&] { return calibrate(view, count, fixed, from_camera, camera, fit, error); });
}

extern "C" weft_code weft_opencv_blur(float *picture, int width, int height, double deviation, weft_error *error)
{
    return weft_opencv_guarded("blurring", error, [&] {
        cv::Mat image(height, width, CV_32F, picture);
        cv::GaussianBlur(image, image, cv::Size(), deviation, deviation, cv::BORDER_REPLICATE);
        return WEFT_OK;
    });
}
