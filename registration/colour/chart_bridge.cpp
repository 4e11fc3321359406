#include "registration/colour/chart_library.h"

#include "registration/pose/opencv_guard.h"

#include <opencv2/imgproc.hpp>
#include <opencv2/mcc.hpp>

#include <algorithm>

namespace
{

/* The finder's time grows with the pixels, its sight does not. It enlarges pictures until their shorter side has
 * `shortest` pixels, however long the other one becomes: that is to stay below `longest_enlarged`. */
constexpr int longest = 1600, shortest = 1000, longest_enlarged = 2000;

cv::Ptr<cv::mcc::DetectorParameters> parameters_for(const cv::Size &size)
{
    cv::Ptr<cv::mcc::DetectorParameters> parameters = cv::mcc::DetectorParameters::create();
    double enlarged = double(longest_enlarged) * std::min(size.width, size.height) / std::max(size.width, size.height);
    parameters->minImageSize = std::max(1, std::min(shortest, int(enlarged)));
    return parameters;
}

void store(const std::vector<cv::Point2f> &box, double scale, weft_chart_sighting *sighting)
{
    for (size_t i = 0; i < 4; i++) {
        sighting->corner[i][0] = (box[i].x + 0.5) / scale - 0.5;
        sighting->corner[i][1] = (box[i].y + 0.5) / scale - 0.5;
    }
}

weft_code find(const uint8_t *rgb, int width, int height, int is_sg, weft_chart_sighting *sighting, int *count,
               weft_error *error)
{
    *count = 0;
    return weft_opencv_guarded("looking for a colour chart", error, [&] {
        const cv::Mat picture(height, width, CV_8UC3, const_cast<uint8_t *>(rgb));
        double scale = std::min(1.0, double(longest) / std::max(width, height));
        cv::Mat bgr;
        cv::cvtColor(picture, bgr, cv::COLOR_RGB2BGR);
        if (scale < 1)
            cv::resize(bgr, bgr, cv::Size(), scale, scale, cv::INTER_AREA);
        cv::theRNG().state = 1;
        cv::Ptr<cv::mcc::CCheckerDetector> detector = cv::mcc::CCheckerDetector::create();
        if (detector->process(bgr, is_sg ? cv::mcc::SG140 : cv::mcc::MCC24, WEFT_CHART_SIGHTINGS, false,
                              parameters_for(bgr.size()))) {
            for (const cv::Ptr<cv::mcc::CChecker> &checker : detector->getListColorChecker())
                if (*count < WEFT_CHART_SIGHTINGS && checker->getBox().size() == 4)
                    store(checker->getBox(), scale, &sighting[(*count)++]);
        }
        return WEFT_OK;
    });
}

} // namespace

extern "C" const weft_chart_library weft_chart_library_table = {find};
