/* Settings of the virtual rig: those of any rig, how its sensor works, how it errs, and how its sample is laid out. */
#ifndef WEFT_CAPTURE_VIRTUAL_VIRTUAL_SETTINGS_H
#define WEFT_CAPTURE_VIRTUAL_VIRTUAL_SETTINGS_H

#include "capture/settings.h"

enum { WEFT_VIRTUAL_CAMERAS_MAX = 8 };

typedef struct weft_virtual_settings {
    weft_rig_settings rig;
    /* The sensor: pixels binned two by two, as cameras do for a reduced raw file. */
    double full_well_electrons;
    double read_noise_electrons;
    double sensitivity_electrons; /* per second, for radiance 1; the light gives irradiance 1 at the origin along its
                                     normal */
    /* Faults of the sensor, which calibration has to find. */
    double sensor_faults;            /* 1 = with what follows; 0 = a sensor without faults */
    double dark_electrons;           /* per second, of the usual pixel */
    double dark_spread;              /* relative standard deviation from pixel to pixel */
    double hot_share, hot_factor;    /* of the pixels; their mean dark current, of the usual one */
    double response_spread;          /* relative standard deviation of the response from pixel to pixel */
    double dust_specks, dust_depth;  /* shadows on the sensor: how many, and the deepest, of the light */
    double field_slope;              /* by which the even field is not: relative, from edge to edge */
    double dark_frames, flat_frames; /* of the sensor, before the first shot */
    double aperture_mm;              /* diameter of the entrance pupil; focused on the camera distance */
    double samples_per_pixel;
    /* Errors: what calibration and nominal pose do not know. */
    double focal_length_error; /* relative */
    double principal_point_error_px;
    double k1_error; /* relative */
    double mounting_rotation_deg, mounting_translation_mm;
    double viewpoint_rotation_deg,
        viewpoint_translation_mm; /* standard deviation per axis, drawn anew for every viewpoint */
    double axes; /* 1 = an arm on a ring turns the camera, with what follows; 0 = it is wherever it is sent */
    double axis_tilt_deg, axis_offset_mm; /* by which the line of each axis is off */
    double axis_zero_deg, axis_scale;     /* of the scale of each axis: its zero, and its length, relative */
    double axis_uneven_deg;               /* amplitude of the errors of the scale, once a turn */
    double axis_wobble_deg;               /* amplitude of the lean of the bearing, once a turn; a third of it thrice */
    double aim_rotation_deg, aim_mm;      /* by which the camera is off on its arm */
    double light_rotation_deg;            /* standard deviation per axis, drawn anew for every move */
    double light_power_drift;             /* relative standard deviation, per exposure */
    double timeout_probability;           /* of an exposure that fails */
    double cameras; /* evenly spaced on a ring that carries all: 1 to WEFT_VIRTUAL_CAMERAS_MAX, each with errors of its
                       own; with more than 1, the lamps stand still */
    /* The sample. */
    double tiles_x, tiles_y; /* of the weave, across the opening; 0 = chosen by the weave */
    double cloth_noise;      /* 1 = with the noise of the weave, 0 = without */
    double bounces;          /* of light between the yarns of a stitch */
} weft_virtual_settings;

/* The virtual rig as it stands in Weft. */
weft_virtual_settings weft_virtual_settings_default(void);

/* Overrides `settings` by the numbers of a JSON file; "rig" names the back end and must be "virtual".
 * Errors: WEFT_BAD_INPUT naming the file and the key, for an unknown key or a value out of its bounds. */
weft_code weft_virtual_settings_read(const char *path, weft_virtual_settings *settings, weft_error *error);

/* The settings, the seed of the virtual rig and the identity of its sample as JSON text, for session.json.
 * The caller frees it. NULL where memory runs out. */
char *weft_virtual_settings_text(const weft_virtual_settings *settings, uint64_t seed, const char *sample_file,
                                 uint32_t sample_crc32);

#endif
