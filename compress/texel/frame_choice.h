/* Which frame the texels of a material have. */
#ifndef WEFT_COMPRESS_TEXEL_FRAME_CHOICE_H
#define WEFT_COMPRESS_TEXEL_FRAME_CHOICE_H

typedef enum weft_frame_choice {
    WEFT_FRAMES_SURFACE, /* that of the surface */
    WEFT_FRAMES_GIVEN,   /* what the dataset says, which may be that of the surface */
    WEFT_FRAMES_FITTED   /* the better of the two, or turned from there, where that helps */
} weft_frame_choice;

#endif
