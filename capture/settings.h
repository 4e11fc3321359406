/* Settings of a rig: how it is set up and calibrated, how it exposes and, for the virtual rig, how it errs.
 * Read from a JSON object whose keys are the names of the fields; docs/reference/session-format.md lists them. */
#ifndef WEFT_CAPTURE_SETTINGS_H
#define WEFT_CAPTURE_SETTINGS_H

#include "btf/session/session.h"

typedef struct weft_rig_settings {
    /* The camera as calibrated (btf/session/camera.h); the principal point is the centre of the photograph. */
    double width_px, height_px, focal_length_px;
    double k1, k2;
    double vignetting_r2, vignetting_r4, vignetting_r6;
    double bits, black_level;
    /* The set-up. */
    double opening_mm;
    double camera_distance_mm, light_distance_mm;
    double camera_half_angle_deg; /* half the angle that the camera covers, seen from the sample */
    /* Exposure. */
    double shortest_exposure_s, longest_exposure_s;
    double retries; /* of an exposure that the camera did not deliver */
    /* The sensor of the virtual camera: pixels binned two by two, as cameras do for a reduced raw file. */
    double full_well_electrons;
    double read_noise_electrons;
    double sensitivity_electrons; /* per second, for radiance 1; the light gives irradiance 1 at the origin along its
                                     normal */
    double aperture_mm;           /* diameter of the entrance pupil; focused on the camera distance */
    double samples_per_pixel;
    /* Errors of the virtual rig: what calibration and nominal pose do not know. */
    double focal_length_error; /* relative */
    double principal_point_error_px;
    double k1_error; /* relative */
    double mounting_rotation_deg, mounting_translation_mm;
    double stay_rotation_deg, stay_translation_mm; /* standard deviation per axis, drawn anew for every stay */
    double light_rotation_deg;                     /* standard deviation per axis, drawn anew for every move */
    double light_power_drift;                      /* relative standard deviation, per exposure */
    double timeout_probability;                    /* of an exposure that fails */
    /* The sample of the virtual rig. */
    double tiles_x, tiles_y; /* of the weave, across the opening; 0 = chosen by the weave */
    double cloth_noise;      /* 1 = with the noise of the weave, 0 = without */
    double bounces;          /* of light between the yarns of a stitch */
} weft_rig_settings;

/* The virtual rig as it stands in Weft. */
weft_rig_settings weft_rig_settings_default(void);

/* Overrides `settings` by the numbers of a JSON file; "rig" names the back end and must be "virtual".
 * Errors: WEFT_BAD_INPUT naming the file and the key, for an unknown key or a value out of its bounds. */
weft_code weft_rig_settings_read(const char *path, weft_rig_settings *settings, weft_error *error);

/* The settings, the seed of the virtual rig and the identity of its sample as JSON text, for session.json.
 * The caller frees it. NULL where memory runs out. */
char *weft_rig_settings_text(const weft_rig_settings *settings, uint64_t seed, const char *sample_file,
                             uint32_t sample_crc32);

/* The camera as calibrated. Pure. */
weft_camera weft_rig_settings_camera(const weft_rig_settings *settings);

#endif
