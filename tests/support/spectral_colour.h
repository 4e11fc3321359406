/* Colours by their spectra, for tests of colour: nothing of the program is in it. Reflectance, lamps and cameras are
 * functions of the wavelength; the eye is that of CIE 1931 as Wyman, Sloan and Shirley (2013) approximate it. */
#ifndef WEFT_TESTS_SUPPORT_SPECTRAL_COLOUR_H
#define WEFT_TESTS_SUPPORT_SPECTRAL_COLOUR_H

/* A smooth reflectance (Jakob and Hanika 2019): 1/2 + x / (2 sqrt(1 + x^2)), x a parabola of the wavelength. */
typedef struct spectral_reflectance {
    double parabola[3];
} spectral_reflectance;

typedef struct spectral_camera {
    double peak_nm[3], width_nm[3];
    double bump[3]; /* of a second, smaller peak 110 nm beside the first: no camera sees like the eye */
} spectral_camera;

typedef struct spectral_lamp {
    double kelvin; /* of a black body */
    double blue;   /* share of a narrow blue line, as white light-emitting diodes have it */
} spectral_lamp;

extern const spectral_camera spectral_cameras[2];
extern const spectral_lamp spectral_lamps[2];

/* The reflectance whose colour under D50 is this CIE L*, a*, b*. The test fails where there is none. */
spectral_reflectance spectral_of_lab_d50(const double lab[3]);

/* A reflectance at random: more saturated than patches of a chart, and less. */
spectral_reflectance spectral_random(unsigned *state);

/* What a camera shows of it under a lamp; a perfect white diffuser is not 1, but what it happens to be. */
void spectral_see(const spectral_camera *camera, const spectral_lamp *lamp, const spectral_reflectance *reflectance,
                  double rgb[3]);

/* The same of a perfect white diffuser. */
void spectral_white(const spectral_camera *camera, const spectral_lamp *lamp, double rgb[3]);

/* CIE L*, a*, b* under D50. */
void spectral_lab_d50(const spectral_reflectance *reflectance, double lab[3]);

#endif
