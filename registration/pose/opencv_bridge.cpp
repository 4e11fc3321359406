#include "registration/pose/opencv_bridge.h"

#include "registration/pose/opencv_guard.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>

extern "C" weft_code weft_opencv_find_markers(const uint8_t *grey, int width, int height, weft_marker *marker,
                                              int *count, weft_error *error)
{
    return weft_opencv_find_markers_of("4X4_50", grey, width, height, marker, WEFT_MARKERS_LIMIT, count, error);
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

extern "C" weft_code weft_opencv_blur(float *picture, int width, int height, double deviation, weft_error *error)
{
    return weft_opencv_guarded("blurring", error, [&] {
        cv::Mat image(height, width, CV_32F, picture);
        cv::GaussianBlur(image, image, cv::Size(), deviation, deviation, cv::BORDER_REPLICATE);
        return WEFT_OK;
    });
}
