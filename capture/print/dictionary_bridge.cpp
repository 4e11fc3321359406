#include "capture/print/dictionary_bridge.h"

#include <opencv2/aruco.hpp>

#include <exception>

extern "C" weft_code weft_board_marker(int id, uint8_t cell[WEFT_BOARD_MARKER_CELLS][WEFT_BOARD_MARKER_CELLS],
                                       weft_error *error)
{
    try {
        const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_100);
        cv::Mat picture;
        dictionary->drawMarker(id, WEFT_BOARD_MARKER_CELLS, picture, 1);
        for (int row = 0; row < WEFT_BOARD_MARKER_CELLS; row++) {
            for (int column = 0; column < WEFT_BOARD_MARKER_CELLS; column++)
                cell[row][column] = picture.at<uint8_t>(row, column) < 128;
        }
        return WEFT_OK;
    } catch (const std::exception &failure) {
        return weft_fail(error, WEFT_SYSTEM, "marker %d failed in OpenCV: %s", id, failure.what());
    }
}
