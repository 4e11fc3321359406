#include "capture/preflight/preflight.h"

/* The limits are those of what registration can make good, with some room: a plate of which half the markers are seen
 * is found, and a point spread of 1.5 pixels is as wide as a texel of half the camera's resolution. */
const weft_preflight_limits weft_preflight_limits_of[WEFT_CHECK_KINDS] = {
    [WEFT_CHECK_TARGET] = {"target", "of 8 markers found", 4, true, 1, true,
                           "uncover the target, and see that all of it is in the picture"},
    [WEFT_CHECK_PLACE] = {"place", "mm from where the rig predicts the target", 5, false, 1, true,
                          "home the axes, and measure distances and zero_deg of the rig file anew"},
    [WEFT_CHECK_FOCUS] = {"focus, frontal", "pixels wide, the image of a point", 1.5, false, 1, true,
                          "focus on the sample, and fix the ring"},
    [WEFT_CHECK_FOCUS_GRAZING] = {"focus, grazing", "pixels wide, the image of a point", 1.8, false, 1, true,
                                  "close the aperture for more depth of field, or leave the lowest views out"},
    [WEFT_CHECK_CLIPPING] = {"clipping", "% of the sample at full scale", 0.01, false, 100, true,
                             "allow shorter exposures, dim the lamp, or use --brackets"},
    [WEFT_CHECK_WHITE] =
        {"white", "% of full scale on the white patches", 0.02, true, 100, true,
         "the sample outshines them: use --brackets; or clean and uncover them, or allow longer exposures"},
    [WEFT_CHECK_WHITE_CLIPPED] = {"white clipped", "% of the white patches at full scale", 0.01, false, 100, true,
                                  "allow shorter exposures, or dim the lamp"},
    [WEFT_CHECK_NOISE] = {"noise", "% of white, of a pixel", 0.02, false, 100, true,
                          "use a lower ISO, longer exposures, or a larger bin"},
    /* Cameras tell the time that is engraved, not the power of two that the shutter keeps: 1/30 to 1/125 is a quarter
     * within 4 %, 15 s to 4 s within 6 %. */
    [WEFT_CHECK_LINEARITY] = {"linearity", "% off, at a quarter of the exposure", 0.08, false, 100, true,
                              "let the camera give raw values, set black_level to what it shows without light, and "
                              "see that its shutter keeps its times"},
    [WEFT_CHECK_STRAY] = {"stray light", "% of white without the lamp", 0.005, false, 100, true,
                          "darken the room, and cover what glows"},
    [WEFT_CHECK_DARK] = {"dark level", "% of full scale without light, in the longest exposure", 0.05, false, 100, true,
                         "darken the room, brighten the lamp for shorter exposures, or cool the camera"},
    /* The light meter reads the 99.5th percentile. */
    [WEFT_CHECK_HOT] = {"hot pixels", "% of the pixels, in the longest exposure", 0.005, false, 100, true,
                        "brighten the lamp for shorter exposures, or cool the camera"},
    [WEFT_CHECK_VIBRATION] = {"vibration", "pixels between two photographs", 0.1, false, 1, true,
                              "raise settle_s, release without touching, and look what shakes the rig"},
    [WEFT_CHECK_DISK] = {"disk", "GB free", 0, true, 1, false, "make room, or choose another disk"},
    [WEFT_CHECK_CALIBRATION] = {"calibration", "days old", 90, false, 1, false, "calibrate the lens again: weft lens"},
};
