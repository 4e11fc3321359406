/* The sensitivity that a TIFF file notes where Exif has it, under tag 34855: OpenImageIO 2.4 passes it over. */
#ifndef WEFT_BASE_PICTURE_TIFF_SENSITIVITY_H
#define WEFT_BASE_PICTURE_TIFF_SENSITIVITY_H

#ifdef __cplusplus
extern "C" {
#endif

/* PhotographicSensitivity (Exif 2.3) of the first picture of a TIFF file (6.0), of either byte order. 0 where the file
 * does not say it, is damaged, or is no TIFF. Thread-safe. */
double weft_tiff_sensitivity(const char *path);

#ifdef __cplusplus
}
#endif
#endif
