/* Where the mip levels of an image lie in one texture: level 0 at the left, the others at its right, so that a shader
 * fetches any level from one sampler (OpenGL's own mip chain halves sizes downward, a material's upward). Pure. */
#ifndef WEFT_PLAYER_TEXTURE_MIP_LAYOUT_H
#define WEFT_PLAYER_TEXTURE_MIP_LAYOUT_H

enum { WEFT_MIP_LEVELS = 16 };

typedef struct weft_mip_area {
    int x, y, width, height;
} weft_mip_area;

typedef struct weft_mip_layout {
    int level_count;
    weft_mip_area area[WEFT_MIP_LEVELS]; /* without the border */
    int width, height;                   /* of the whole */
} weft_mip_layout;

/* Level k + 1 has ceil half the size of level k. At the end of its rows and columns `border` texels are left free, and
 * more up to the next multiple of `block`: every level begins at one. */
weft_mip_layout weft_mip_layout_of(int width, int height, int level_count, int border, int block);

/* The areas as shaders take them: x, y, width, height. */
void weft_mip_layout_areas(const weft_mip_layout *layout, float area[WEFT_MIP_LEVELS][4]);

/* Number of levels down to 1 x 1, at most WEFT_MIP_LEVELS. */
int weft_mip_level_count(int width, int height);

#endif
