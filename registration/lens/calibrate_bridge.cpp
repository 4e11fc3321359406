#include "registration/lens/calibrate_bridge.h"

#include "registration/pose/opencv_guard.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace
{

using double_pair = double[2];

cv::Mat wrap(const uint8_t *grey, int width, int height)
{
    return cv::Mat(height, width, CV_8U, const_cast<uint8_t *>(grey));
}

/* Large photographs are searched at a size at which squares are no larger than the search expects. */
bool find_chessboard(const cv::Mat &picture, const cv::Size &size, std::vector<cv::Point2f> *corners)
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
    return found;
}

void store(const std::vector<cv::Point2f> &corners, double_pair *corner)
{
    for (size_t i = 0; i < corners.size(); i++) {
        corner[i][0] = corners[i].x;
        corner[i][1] = corners[i].y;
    }
}

/* ---- Calibration ---- */

struct views_of_board {
    std::vector<std::vector<cv::Point3f>> board;
    std::vector<std::vector<cv::Point2f>> seen;
};

views_of_board split_views(int views, const int *point_count, const double_pair *board_mm, const double_pair *pixel)
{
    views_of_board split;
    size_t at = 0;
    for (int view = 0; view < views; view++) {
        split.board.emplace_back();
        split.seen.emplace_back();
        for (int i = 0; i < point_count[view]; i++, at++) {
            split.board.back().emplace_back(float(board_mm[at][0]), float(board_mm[at][1]), 0.f);
            split.seen.back().emplace_back(float(pixel[at][0]), float(pixel[at][1]));
        }
    }
    return split;
}

int flags_of(const weft_lens_model &model)
{
    return (model.k2 ? 0 : cv::CALIB_FIX_K2) | (model.k3 ? 0 : cv::CALIB_FIX_K3) |
           (model.tangential ? 0 : cv::CALIB_ZERO_TANGENT_DIST);
}

void measure_residuals(const views_of_board &views, const cv::Mat &matrix, const cv::Mat &coefficients,
                       const std::vector<cv::Mat> &rotations, const std::vector<cv::Mat> &translations,
                       double_pair *residual_px)
{
    size_t at = 0;
    for (size_t view = 0; view < views.board.size(); view++) {
        std::vector<cv::Point2f> projected;
        cv::projectPoints(views.board[view], rotations[view], translations[view], matrix, coefficients, projected);
        for (size_t i = 0; i < projected.size(); i++, at++) {
            residual_px[at][0] = views.seen[view][i].x - projected[i].x;
            residual_px[at][1] = views.seen[view][i].y - projected[i].y;
        }
    }
}

} // namespace

extern "C" weft_code weft_opencv_find_chessboard(const uint8_t *grey, int width, int height, int columns, int rows,
                                                 double (*corner)[2], int *found, weft_error *error)
{
    *found = 0;
    return weft_opencv_guarded("finding a chessboard", error, [&] {
        std::vector<cv::Point2f> corners;
        if (find_chessboard(wrap(grey, width, height), cv::Size(columns, rows), &corners) &&
            corners.size() == size_t(columns) * size_t(rows)) {
            *found = 1;
            store(corners, corner);
        }
        return WEFT_OK;
    });
}

extern "C" weft_code weft_opencv_refine_corners(const uint8_t *grey, int width, int height, double (*corner)[2],
                                                int count, int reach, weft_error *error)
{
    return weft_opencv_guarded("refining corners", error, [&] {
        std::vector<cv::Point2f> corners;
        for (int i = 0; i < count; i++)
            corners.emplace_back(float(corner[i][0]), float(corner[i][1]));
        if (count > 0)
            cv::cornerSubPix(wrap(grey, width, height), corners, cv::Size(reach, reach), cv::Size(-1, -1),
                             cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-3));
        store(corners, corner);
        return WEFT_OK;
    });
}

extern "C" weft_code weft_opencv_calibrate(int width, int height, int views, const int *point_count,
                                           const double (*board_mm)[2], const double (*pixel)[2],
                                           const weft_lens_model *model, double value[WEFT_LENS_VALUES],
                                           double standard_error[WEFT_LENS_VALUES], double (*rotation)[3],
                                           double (*residual_px)[2], double *rms_px, weft_error *error)
{
    return weft_opencv_guarded("calibrating", error, [&] {
        const views_of_board split = split_views(views, point_count, board_mm, pixel);
        cv::Mat matrix, coefficients, deviations, pose_deviations, view_errors;
        std::vector<cv::Mat> rotations, translations;
        *rms_px = cv::calibrateCamera(split.board, split.seen, cv::Size(width, height), matrix, coefficients, rotations,
                                      translations, deviations, pose_deviations, view_errors, flags_of(*model),
                                      cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-12));
        const double values[WEFT_LENS_VALUES] = {
            matrix.at<double>(0, 0),    matrix.at<double>(1, 1),    matrix.at<double>(0, 2),
            matrix.at<double>(1, 2),    coefficients.at<double>(0), coefficients.at<double>(1),
            coefficients.at<double>(2), coefficients.at<double>(3), coefficients.at<double>(4)};
        for (int i = 0; i < WEFT_LENS_VALUES; i++) {
            value[i] = values[i];
            standard_error[i] = deviations.at<double>(i);
            if (!std::isfinite(value[i]) || (i < 2 && value[i] <= 0))
                return weft_fail(error, WEFT_BAD_INPUT, "no lens fits the photographs");
        }
        for (int view = 0; view < views; view++) {
            for (int axis = 0; axis < 3; axis++)
                rotation[view][axis] = rotations[size_t(view)].at<double>(axis);
        }
        measure_residuals(split, matrix, coefficients, rotations, translations, residual_px);
        return WEFT_OK;
    });
}
