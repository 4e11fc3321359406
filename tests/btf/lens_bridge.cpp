#include "tests/btf/lens_bridge.h"

#include <opencv2/calib3d.hpp>

#include <vector>

static cv::Mat matrix_of(const double lens[9])
{
    return (cv::Mat_<double>(3, 3) << lens[0], 0, lens[2], 0, lens[1], lens[3], 0, 0, 1);
}

static cv::Mat coefficients_of(const double lens[9])
{
    return (cv::Mat_<double>(1, 5) << lens[4], lens[5], lens[6], lens[7], lens[8]);
}

extern "C" void opencv_project(const double lens[9], double x, double y, double pixel[2])
{
    const cv::Mat none = cv::Mat::zeros(3, 1, CV_64F);
    std::vector<cv::Point2d> seen;
    cv::projectPoints(std::vector<cv::Point3d>{{x, y, 1}}, none, none, matrix_of(lens), coefficients_of(lens), seen);
    pixel[0] = seen[0].x;
    pixel[1] = seen[0].y;
}

extern "C" void opencv_undistort(const double lens[9], const double distorted[2], double pixel[2])
{
    std::vector<cv::Point2d> seen;
    const cv::Mat matrix = matrix_of(lens);
    cv::undistortPoints(std::vector<cv::Point2d>{{distorted[0], distorted[1]}}, seen, matrix, coefficients_of(lens),
                        cv::noArray(), matrix,
                        cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 500, 1e-12));
    pixel[0] = seen[0].x;
    pixel[1] = seen[0].y;
}
