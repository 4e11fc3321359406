/* The sources of the shaders, embedded when the program is built (cmake/embed_text.cmake). NUL-terminated. */
#ifndef WEFT_PLAYER_GL_SHADERS_H
#define WEFT_PLAYER_GL_SHADERS_H

extern const char weft_glsl_fullscreen_vert[];
extern const char weft_glsl_background_frag[], weft_glsl_ground_frag[];
extern const char weft_glsl_add_frag[];
extern const char weft_glsl_enlarge_frag[];
extern const char weft_glsl_present_frag[];
extern const char weft_glsl_text_vert[];
extern const char weft_glsl_text_frag[];

extern const char weft_glsl_surface_vert[];
extern const char weft_glsl_mesh_point[], weft_glsl_surface_frag[];
extern const char weft_glsl_rotation[];
extern const char weft_glsl_surface[];
extern const char weft_glsl_environment_frag[];
extern const char weft_glsl_directions[];
extern const char weft_glsl_tables[], weft_glsl_compressed[], weft_glsl_factorised[];
extern const char weft_glsl_raw[];
extern const char weft_glsl_analytic[], weft_glsl_threads[];
extern const char weft_glsl_shade_frag[], weft_glsl_depth_frag[], weft_glsl_cast_frag[];
extern const char weft_glsl_geometry_frag[];

/* From reflectance/. */
extern const char weft_glsl_lafortune[];
extern const char weft_glsl_components[], weft_glsl_relief[];
extern const char weft_glsl_woven[];
extern const char weft_glsl_weave[], weft_glsl_weave_mean[];
extern const char weft_glsl_microcylinder[];

#endif
