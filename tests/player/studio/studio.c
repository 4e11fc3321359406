#include "studio.h"

#include "player/scene/surroundings.h"

weft_image studio_map(const char *name)
{
    weft_error error = {0};
    weft_image map;
    expect_ok(weft_surroundings_map(name, &map, &error), &error);
    return map;
}

void studio_show(weft_player *player, const char *mesh_name)
{
    weft_error error = {0};
    weft_mesh mesh;
    weft_material material;
    expect_ok(weft_mesh_open(mesh_name, &mesh, &error), &error);
    expect_ok(weft_player_set_mesh(player, &mesh, &error), &error);
    weft_mesh_free(&mesh);
    /* One smooth texel: what changes from pixel to pixel is shading. */
    expect_ok(weft_material_create(1, 1, 0, 0, 0, true, &material, &error), &error);
    weft_frame frame = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
    weft_frame_encode(&frame, material.level[0].frame);
    for (int c = 0; c < 3; c++)
        material.level[0].diffuse[c] = weft_half_of_float(0.4f);
    material.texel_pitch_mm = 1;
    expect_ok(weft_player_set_material(player, &material, &error), &error);
    weft_material_free(&material);
}

weft_scene studio_scene(weft_player *player, const char *name, int regions)
{
    weft_error error = {0};
    weft_image map = studio_map(name);
    weft_scene scene = weft_scene_default();
    expect_ok(weft_player_set_environment(player, &map, regions, &error), &error);
    weft_image_free(&map);
    weft_surroundings_light(name, &scene);
    scene.shadows = scene.ground = true;
    return scene;
}

weft_image studio_picture(weft_player *player, const weft_scene *scene)
{
    weft_error error = {0};
    weft_image image;
    expect_ok(weft_player_picture(player, scene, WIDTH, HEIGHT, 1, NULL, &image, &error), &error);
    return image;
}
