#include "cli/arguments.h"
#include "cli/scene_errors.h"
#include "cli/scene_options.h"

#include "player/context.h"
#include "player/interaction.h"

#include <limits.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

typedef struct play_command {
    scene_options scene;
    int frame_limit; /* 0 = until the window is closed */
} play_command;

/* While nothing moves, this many frames with shifted pixels are averaged, then drawing rests. */
enum { STILL_FRAMES = 16, KEY_FRAMES = 0x5000 };

static const struct argp_option option_table[] = {
    {"frames", KEY_FRAMES, "N", 0, "Quit after N frames", 0},
    {0},
};

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    play_command *command = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &command->scene;
        return 0;
    case KEY_FRAMES:
        command->frame_limit = (int)parse_whole("frames", argument, 1, INT_MAX, state);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child children[] = {{&scene_argp, 0, NULL, 1}, {0}};

static const struct argp parser = {
    option_table,
    parse_option,
    "[NAME.weft]",
    "Example: weft play silk.weft --raw silk.btf.h5 --weave silk.wv\n\n"
    "Shows a material in a window; drag to turn it, drag with the right button to move the light, H for all keys.",
    children,
    NULL,
    NULL};

typedef struct play {
    play_command *command;
    weft_window *window;
    weft_player *player;
    weft_canvas canvas;
    weft_interaction interaction;
    double frame_ms; /* smoothed */
    double titled_s; /* when the title was set last */
    long frame_count;
    char errors[SCENE_ERRORS_SIZE]; /* of what is shown, "" until it rests */
} play;

static double now_s(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* ---- Events ---- */

static void on_press(void *context, int button, bool pressed, bool shift, double x, double y)
{
    weft_interaction_press(context, button, pressed, shift, x, y);
}

static void on_move(void *context, double x, double y)
{
    weft_interaction_move(context, x, y);
}

static void on_scroll(void *context, double steps)
{
    weft_interaction_scroll(context, steps);
}

static void on_key(void *context, int key)
{
    weft_interaction_key(context, key);
}

/* ---- Frames ---- */

static void set_title(play *p)
{
    double now = now_s();
    if (now - p->titled_s < 0.25)
        return;
    p->titled_s = now;
    const weft_scene *scene = &p->interaction.scene;
    char title[256 + SCENE_ERRORS_SIZE];
    snprintf(title, sizeof title, "Weft - %s%s - mips %s - %.1f ms/frame%s%s - H for help",
             scene->pane_count > 1 ? "side by side" : weft_mode_name(scene->pane[0]),
             p->interaction.drag_moves_light ? " - drag moves the light" : "",
             scene->level_choice == WEFT_LEVEL_NONE ? "off" : "on", p->frame_ms, p->errors[0] ? " - " : "", p->errors);
    weft_window_set_title(p->window, title);
}

/* A canvas as large as the window, cleared when the picture is out of date. */
static weft_code prepare_canvas(play *p, weft_error *error)
{
    weft_interaction *i = &p->interaction;
    weft_window_size(p->window, &i->width, &i->height);
    if (i->changed)
        p->errors[0] = 0;
    bool resized = i->width != p->canvas.width || i->height != p->canvas.height;
    if (resized && i->width > 0 && i->height > 0) {
        weft_canvas_free(&p->canvas);
        WEFT_TRY(weft_canvas_create(i->width, i->height, &p->canvas, error));
    } else if (i->changed) {
        weft_canvas_clear(&p->canvas);
    }
    i->changed = false;
    return WEFT_OK;
}

/* Radical inverses: any first few of these shifts spread evenly over the pixel. */
static double radical_inverse(int index, int base)
{
    double result = 0, digit = 1;
    for (; index > 0; index /= base) {
        digit /= base;
        result += digit * (index % base);
    }
    return result;
}

static weft_code draw_frame(play *p, weft_error *error)
{
    double start = now_s();
    int index = p->canvas.frame_count;
    weft_sampling sampling = {
        .frame = index,
        .shift_x = index > 0 ? radical_inverse(index, 2) - 0.5 : 0,
        .shift_y = index > 0 ? radical_inverse(index, 3) - 0.5 : 0,
    };
    weft_canvas_begin_frame(&p->canvas);
    WEFT_TRY(weft_player_draw(p->player, &p->interaction.scene, p->canvas.width, p->canvas.height, sampling, error));
    weft_canvas_end_frame(&p->canvas);
    glFinish();
    double elapsed_ms = 1000 * (now_s() - start);
    p->frame_ms = p->frame_count > 0 ? 0.9 * p->frame_ms + 0.1 * elapsed_ms : elapsed_ms;
    p->frame_count++;
    return WEFT_OK;
}

/* ---- Wishes ---- */

/* The first free of weft-001.png, weft-002.png, ... in the current folder. */
static weft_code save_screenshot(play *p, weft_error *error)
{
    char path[32];
    int number = 1;
    do
        snprintf(path, sizeof path, "weft-%03d.png", number++);
    while (access(path, F_OK) == 0 && number < 1000);
    weft_image image = {0};
    WEFT_TRY(weft_canvas_read(&p->canvas, &image, error));
    weft_code code = scene_write_image(path, &p->interaction.scene, &image, error);
    weft_image_free(&image);
    if (code == WEFT_OK)
        command_say(&p->command->scene.common, "saved %s", path);
    return code;
}

static weft_code change_mesh(play *p, weft_error *error)
{
    weft_mesh mesh = {0};
    weft_code code = weft_mesh_open(p->interaction.wants_mesh, &mesh, error);
    if (code == WEFT_OK)
        code = weft_player_set_mesh(p->player, &mesh, error);
    weft_mesh_free(&mesh);
    p->interaction.wants_mesh = NULL;
    p->interaction.changed = true;
    return code;
}

static weft_code grant_wishes(play *p, weft_error *error)
{
    weft_interaction *i = &p->interaction;
    if (i->wants_mesh)
        WEFT_TRY(change_mesh(p, error));
    /* A picture is saved once it is smooth: never one that is out of date. */
    bool is_smooth = p->canvas.frame_count >= STILL_FRAMES && !i->changed;
    if (i->wants_screenshot && is_smooth) {
        i->wants_screenshot = false;
        WEFT_TRY(save_screenshot(p, error));
    }
    if (i->wants_quit)
        weft_window_close(p->window);
    return WEFT_OK;
}

static weft_code run(play *p, weft_error *error)
{
    const weft_interaction *i = &p->interaction;
    int limit = p->command->frame_limit;
    bool resting = false;
    while (weft_window_poll(p->window, resting ? 0.1 : 0) && (limit == 0 || p->frame_count < limit)) {
        WEFT_TRY(grant_wishes(p, error));
        WEFT_TRY(prepare_canvas(p, error));
        if (p->interaction.width == 0 || p->interaction.height == 0) {
            resting = true;
            continue;
        }
        if (limit > 0 && p->canvas.frame_count >= STILL_FRAMES)
            weft_canvas_clear(&p->canvas);
        resting = p->canvas.frame_count >= STILL_FRAMES;
        if (!resting)
            WEFT_TRY(draw_frame(p, error));
        if (p->canvas.frame_count == STILL_FRAMES && !resting)
            WEFT_TRY(scene_errors_print(p->player, &i->scene, p->canvas.width, p->canvas.height, p->errors, error));
        weft_canvas_present(&p->canvas, &i->scene);
        weft_window_show(p->window);
        set_title(p);
    }
    return WEFT_OK;
}

static weft_code open_and_run(play *p, weft_error *error)
{
    scene_options *options = &p->command->scene;
    const weft_window_events events = {on_press, on_move, on_scroll, on_key, &p->interaction};
    WEFT_TRY(weft_window_create("Weft", options->width, options->height, &events, &p->window, error));
    WEFT_TRY(weft_player_create(&p->player, error));
    WEFT_TRY(scene_load(options, p->player, error));
    p->interaction.scene = options->scene;
    for (int mode = 0; mode < WEFT_MODE_COUNT; mode++)
        p->interaction.available[mode] = weft_player_has(p->player, (weft_mode)mode);
    return run(p, error);
}

int command_play(int argc, char **argv)
{
    play_command command = {0};
    command_parse(&parser, argc, argv, &command, &command.scene.common);
    weft_error error = {0};
    play p = {.command = &command};
    weft_code code = open_and_run(&p, &error);
    if (code == WEFT_OK)
        command_say(&command.scene.common, "%ld frames, %.1f ms each, drawn by %s", p.frame_count, p.frame_ms,
                    weft_gl_renderer());
    if (p.window)
        weft_canvas_free(&p.canvas);
    weft_player_free(p.player);
    weft_window_free(p.window);
    return command_exit("play", &command.scene.common, code, &error);
}
