/* The typeface of the user interface and of labels: Roboto, as a TrueType file in memory (put there by the build). */
#ifndef WEFT_BASE_PICTURE_FONT_FILE_H
#define WEFT_BASE_PICTURE_FONT_FILE_H

#ifdef __cplusplus
extern "C" {
#endif

extern const unsigned char weft_font_file[];
extern const unsigned int weft_font_file_size;

#ifdef __cplusplus
}
#endif
#endif
