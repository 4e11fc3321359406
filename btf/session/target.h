/* The target plate: a printed disc with a square opening for the sample, eight fiducial markers round it
 * (ArUco, DICT_4X4_50, ids 0..7) and four patches of white reference. It lies in the plane z = 0 of the sample.
 * The rig photographs it and registration compares the photographs with this drawing, so both read it here. */
#ifndef WEFT_BTF_SESSION_TARGET_H
#define WEFT_BTF_SESSION_TARGET_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct weft_target {
    double opening_mm;        /* side of the square opening, centred at the origin */
    double white_reflectance; /* of the reference patches (diffuse) */
    double paper_reflectance; /* of the bare print */
    double ink_reflectance;   /* of the black print */
} weft_target;

typedef enum weft_target_region {
    WEFT_TARGET_OPENING,   /* the sample */
    WEFT_TARGET_PRINT,     /* paper or ink */
    WEFT_TARGET_REFERENCE, /* white reference */
    WEFT_TARGET_OUTSIDE    /* off the plate: black */
} weft_target_region;

enum {
    WEFT_TARGET_MARKER_COUNT = 8, /* on the plate */
    WEFT_SHEET_MARKER_COUNT = 14, /* on the printed sheet: the plate's come first */
    WEFT_TARGET_REFERENCE_COUNT = 4,
    WEFT_TARGET_BALL_COUNT = 2
};

/* Axis-aligned rectangle, mm. */
typedef struct weft_rectangle {
    double x0, y0, x1, y1;
} weft_rectangle;

/* The plate of a rig, for an opening of the given side: its patches are a white standard. Pure, as all functions here.
 */
weft_target weft_target_for_opening(double opening_mm);

/* The same drawing as a sheet of plain paper out of a printer: its patches are bare paper. The reflectances are typical
 * of office paper and of toner. Papers differ by some 5 %. */
weft_target weft_target_printed(double opening_mm);

double weft_target_radius_mm(const weft_target *target);

weft_target_region weft_target_region_at(const weft_target *target, double x_mm, double y_mm);

/* Diffuse reflectance at a point of the plate (0 in the opening and outside). */
double weft_target_reflectance(const weft_target *target, double x_mm, double y_mm);

/* Outline of marker `id` in [0, WEFT_SHEET_MARKER_COUNT), upright (its top edge toward +y). */
weft_rectangle weft_target_marker(const weft_target *target, int id);

/* A sheet holds the plate in its middle, and things that tell the light in its corners: two mirror balls in opposite
 * ones, and a pin. Its sides are 124 and 168 32nds of the opening's. */
weft_rectangle weft_target_sheet(const weft_target *target);

/* Where ball `index` in [0, WEFT_TARGET_BALL_COUNT) touches the sheet, and where the pin stands upright: x and y, mm.
 */
void weft_target_ball(const weft_target *target, int index, double place_mm[2]);
void weft_target_pin(const weft_target *target, double place_mm[2]);

/* Diffuse reflectance at a point of the printed sheet: as above on the plate, else of the outer markers and the paper
 * round it. They show what the lens does far from the plate, where the balls stand. */
double weft_target_sheet_reflectance(const weft_target *target, double x_mm, double y_mm);

/* Outline of reference patch `index` in [0, WEFT_TARGET_REFERENCE_COUNT). */
weft_rectangle weft_target_reference(const weft_target *target, int index);

#ifdef __cplusplus
}
#endif
#endif
