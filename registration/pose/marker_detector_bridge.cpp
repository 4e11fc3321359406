#include "registration/pose/marker_detector.h"

#include "registration/pose/marker_edges.h"

#include <opencv2/aruco.hpp>

#include <cstring>
#include <exception>
#include <new>
#include <vector>

namespace
{

struct named_dictionary {
    const char *name;
    cv::aruco::PREDEFINED_DICTIONARY_NAME id;
    int size;
};

constexpr named_dictionary dictionaries[] = {
    {"4X4_50", cv::aruco::DICT_4X4_50, 50},
    {"4X4_100", cv::aruco::DICT_4X4_100, 100},
    {"4X4_250", cv::aruco::DICT_4X4_250, 250},
    {"4X4_1000", cv::aruco::DICT_4X4_1000, 1000},
    {"5X5_50", cv::aruco::DICT_5X5_50, 50},
    {"5X5_100", cv::aruco::DICT_5X5_100, 100},
    {"5X5_250", cv::aruco::DICT_5X5_250, 250},
    {"5X5_1000", cv::aruco::DICT_5X5_1000, 1000},
    {"6X6_50", cv::aruco::DICT_6X6_50, 50},
    {"6X6_100", cv::aruco::DICT_6X6_100, 100},
    {"6X6_250", cv::aruco::DICT_6X6_250, 250},
    {"6X6_1000", cv::aruco::DICT_6X6_1000, 1000},
    {"7X7_50", cv::aruco::DICT_7X7_50, 50},
    {"7X7_100", cv::aruco::DICT_7X7_100, 100},
    {"7X7_250", cv::aruco::DICT_7X7_250, 250},
    {"7X7_1000", cv::aruco::DICT_7X7_1000, 1000},
    {"ARUCO_ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL, 1024},
    {"APRILTAG_16h5", cv::aruco::DICT_APRILTAG_16h5, 30},
    {"APRILTAG_25h9", cv::aruco::DICT_APRILTAG_25h9, 35},
    {"APRILTAG_36h10", cv::aruco::DICT_APRILTAG_36h10, 2320},
    {"APRILTAG_36h11", cv::aruco::DICT_APRILTAG_36h11, 587},
};

const named_dictionary *find_dictionary(const char *name)
{
    for (const named_dictionary &each : dictionaries)
        if (strcasecmp(each.name, name) == 0)
            return &each;
    return nullptr;
}

int find(const named_dictionary &named, const cv::Mat &picture, weft_marker *marker, int limit)
{
    const auto dictionary = cv::aruco::getPredefinedDictionary(named.id);
    const auto parameters = cv::aruco::DetectorParameters::create();
    parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
    std::vector<std::vector<cv::Point2f>> corners;
    std::vector<int> ids;
    cv::aruco::detectMarkers(picture, dictionary, corners, ids, parameters);
    int count = 0;
    for (size_t found = 0; found < ids.size() && count < limit; found++) {
        weft_marker *next = &marker[count++];
        next->id = ids[found];
        for (size_t corner = 0; corner < 4; corner++) {
            next->corner[corner][0] = corners[found][corner].x;
            next->corner[corner][1] = corners[found][corner].y;
        }
        weft_marker_refine(picture.data, picture.cols, picture.rows, dictionary->markerSize + 2, next->corner);
    }
    return count;
}

} // namespace

extern "C" int weft_marker_dictionary_size(const char *dictionary)
{
    const named_dictionary *named = find_dictionary(dictionary);
    return named ? named->size : 0;
}

extern "C" weft_code weft_opencv_find_markers_of(const char *dictionary, const uint8_t *grey, int width, int height,
                                                 weft_marker *marker, int limit, int *count, weft_error *error)
{
    *count = 0;
    const named_dictionary *named = find_dictionary(dictionary);
    if (!named)
        return weft_fail(error, WEFT_BAD_USAGE, "there is no dictionary '%s' of markers", dictionary);
    try {
        const cv::Mat picture(height, width, CV_8U, const_cast<uint8_t *>(grey));
        *count = find(*named, picture, marker, limit);
        return WEFT_OK;
    } catch (const std::bad_alloc &) {
        return weft_fail_memory(error, "finding markers", 0);
    } catch (const std::exception &failure) {
        return weft_fail(error, WEFT_SYSTEM, "finding markers failed in OpenCV: %s", failure.what());
    }
}
