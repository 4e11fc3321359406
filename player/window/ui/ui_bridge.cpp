#include "player/window/ui/ui_bridge.h"

#include "base/picture/font_file.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui/backends/imgui_impl_glfw.h>
#include <imgui/backends/imgui_impl_opengl3.h>
#include <imgui/imgui.h>

#include <algorithm>
#include <cfloat>
#include <cstdio>
#include <deque>

namespace
{

double scale_of_all = 1;
float wrap_at = 0;              /* from the left of the panel or note; 0: its right edge */
const char *room_for = nullptr; /* text that the next note is at least as large as */

double pointer_moved_s = 0; /* last, by ImGui's clock */
const double hint_waits_s = 0.4;

const float label_width = 82, text_size = 15, widest_note = 560, narrowest_note = 160, smallest_list = 0.75f;
const ImVec4 accent(0.86f, 0.47f, 0.30f, 1), dim(0.62f, 0.62f, 0.64f, 1);

float scaled(double length)
{
    return (float)(length * scale_of_all);
}

void set_colours(ImGuiStyle &style)
{
    ImVec4 *c = style.Colors;
    const ImVec4 ground(0.105f, 0.108f, 0.115f, 0.97f), raised(0.20f, 0.205f, 0.215f, 1), lit(0.27f, 0.275f, 0.29f, 1);
    c[ImGuiCol_Text] = ImVec4(0.90f, 0.90f, 0.89f, 1);
    c[ImGuiCol_WindowBg] = ground;
    c[ImGuiCol_PopupBg] = ground;
    c[ImGuiCol_Border] = ImVec4(1, 1, 1, 0.06f);
    c[ImGuiCol_FrameBg] = raised;
    c[ImGuiCol_FrameBgHovered] = c[ImGuiCol_FrameBgActive] = lit;
    c[ImGuiCol_Button] = raised;
    c[ImGuiCol_ButtonHovered] = lit;
    c[ImGuiCol_ButtonActive] = accent;
    c[ImGuiCol_Header] = ImVec4(0, 0, 0, 0);
    c[ImGuiCol_HeaderHovered] = c[ImGuiCol_HeaderActive] = ImVec4(1, 1, 1, 0.05f);
    c[ImGuiCol_SliderGrab] = ImVec4(0.40f, 0.405f, 0.42f, 1);
    c[ImGuiCol_SliderGrabActive] = c[ImGuiCol_CheckMark] = c[ImGuiCol_PlotHistogram] = accent;
    c[ImGuiCol_Separator] = ImVec4(1, 1, 1, 0.08f);
}

void set_style()
{
    ImGuiStyle &style = ImGui::GetStyle();
    style.WindowRounding = 0;
    style.FrameRounding = 4;
    style.GrabRounding = 3;
    style.WindowBorderSize = 0;
    style.WindowPadding = ImVec2(14, 10);
    style.FramePadding = ImVec2(7, 4);
    style.ItemSpacing = ImVec2(7, 5);
    style.ScrollbarSize = 10;
    set_colours(style);
    style.ScaleAllSizes((float)scale_of_all);
}

void load_font()
{
    ImFontConfig config;
    config.FontDataOwnedByAtlas = false;
    ImGui::GetIO().Fonts->AddFontFromMemoryTTF((void *)weft_font_file, (int)weft_font_file_size, scaled(text_size),
                                               &config);
}

/* With this text in it, wrapped as it will be. */
ImVec2 size_of_note(const char *text)
{
    const ImVec2 padding = ImGui::GetStyle().WindowPadding;
    const ImVec2 letters = ImGui::CalcTextSize(text, nullptr, false, wrap_at - padding.x);
    return ImVec2(letters.x + 2 * padding.x, letters.y + 2 * padding.y);
}

/* Of the last widget, where the pointer rests on it. */
void show_hint(const char *label)
{
    const char *hint = weft_hint_of(label);
    const bool rests = ImGui::GetTime() - pointer_moved_s >= hint_waits_s && !ImGui::IsAnyMouseDown();
    if (hint && rests && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        ImGui::SetTooltip("%s", hint);
}

void put_label(const char *label)
{
    ImGui::AlignTextToFramePadding();
    ImGui::PushStyleColor(ImGuiCol_Text, dim);
    ImGui::TextUnformatted(label);
    ImGui::PopStyleColor();
    show_hint(label);
    ImGui::SameLine(scaled(label_width) + ImGui::GetStyle().WindowPadding.x);
    ImGui::SetNextItemWidth(-1);
    ImGui::PushID(label);
}

ImU32 colour_of(uint32_t rgba)
{
    return IM_COL32(rgba >> 24, rgba >> 16 & 255, rgba >> 8 & 255, rgba & 255);
}

/* Of a list of names and meanings, in letters of the usual size. */
struct list_shape {
    size_t middle, longest;
    bool has_second;
    float name, meaning;
    float gap = scaled(28), spacing = scaled(4);
};

float width_of(const list_shape &shape)
{
    return (shape.name + shape.meaning) * (shape.has_second ? 2.0f : 1.0f) + (shape.has_second ? shape.gap : 0);
}

float height_of(const list_shape &shape)
{
    return (float)shape.longest * (ImGui::GetFontSize() + shape.spacing);
}

list_shape shape_of(const weft_ui_entry *line, size_t count, size_t middle)
{
    list_shape shape = {middle, std::max(middle, count - middle), middle < count, 0, 0};
    for (size_t i = 0; i < count; i++) {
        if (line[i].meaning) {
            shape.name = std::max(shape.name, ImGui::CalcTextSize(line[i].name).x);
            shape.meaning = std::max(shape.meaning, ImGui::CalcTextSize(line[i].meaning).x);
        }
    }
    shape.name += scaled(32);
    return shape;
}

void put_column(const weft_ui_entry *line, size_t count, float name_width)
{
    ImGui::BeginGroup();
    for (size_t i = 0; i < count; i++) {
        ImGui::PushStyleColor(ImGuiCol_Text, line[i].meaning ? ImGui::GetStyle().Colors[ImGuiCol_Text] : accent);
        ImGui::TextUnformatted(line[i].name);
        ImGui::PopStyleColor();
        if (!line[i].meaning)
            continue;
        ImGui::SameLine(name_width);
        ImGui::PushStyleColor(ImGuiCol_Text, dim);
        ImGui::TextUnformatted(line[i].meaning);
        ImGui::PopStyleColor();
    }
    ImGui::EndGroup();
}

const ImGuiWindowFlags fixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                               ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse;

/* ---- The mouse ----
 *
 * This Dear ImGui asks once a frame where the mouse is by then. Where a frame is slow, a click would be taken for one
 * at the place to which the pointer has gone on since. So what the mouse did waits here, and a frame sees one press or
 * release of it. */

struct mouse_event {
    ImVec2 at;
    int button; /* or none: it was moved */
    bool pressed;
};

const int none = -1;
std::deque<mouse_event> waiting;
ImVec2 last_place;
bool is_down[ImGuiMouseButton_COUNT];
GLFWcursorposfun move_before;
GLFWmousebuttonfun button_before;

void on_move(GLFWwindow *window, double x, double y)
{
    if (move_before)
        move_before(window, x, y);
    last_place = ImVec2((float)x, (float)y);
    if (!waiting.empty() && waiting.back().button == none)
        waiting.pop_back();
    waiting.push_back({last_place, none, false});
}

void on_button(GLFWwindow *window, int button, int action, int modifiers)
{
    if (button_before)
        button_before(window, button, action, modifiers);
    if (button < ImGuiMouseButton_COUNT)
        waiting.push_back({last_place, button, action == GLFW_PRESS});
}

void listen_to_mouse(GLFWwindow *window)
{
    move_before = glfwSetCursorPosCallback(window, on_move);
    button_before = glfwSetMouseButtonCallback(window, on_button);
}

/* Up to the next press or release; where a widget was dragged to is seen before it is let go. */
void hear_mouse()
{
    static ImVec2 at(-1, -1);
    bool was_moved = false, was_button = false;
    while (!waiting.empty() && !was_button) {
        const mouse_event event = waiting.front();
        const bool is_release = event.button != none && !event.pressed;
        if (is_release && was_moved)
            break;
        waiting.pop_front();
        at = event.at;
        was_button = event.button != none;
        was_moved = !was_button;
        if (was_button)
            is_down[event.button] = event.pressed;
    }
    ImGuiIO &io = ImGui::GetIO();
    bool is_outside = io.MousePos.x < -1e6f;
    if (!is_outside && at.x >= 0)
        io.MousePos = at;
    std::copy(std::begin(is_down), std::end(is_down), io.MouseDown);
}

} // namespace

weft_code weft_ui_create(void *glfw_window, double scale, weft_error *error)
try {
    scale_of_all = scale;
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    set_style();
    load_font();
    if (ImGui_ImplGlfw_InitForOpenGL((GLFWwindow *)glfw_window, true) && ImGui_ImplOpenGL3_Init("#version 330 core")) {
        listen_to_mouse((GLFWwindow *)glfw_window);
        return WEFT_OK;
    }
    return weft_fail(error, WEFT_SYSTEM, "cannot draw the user interface with this OpenGL");
} catch (...) {
    return weft_fail(error, WEFT_SYSTEM, "cannot make the user interface");
}

void weft_ui_free(void)
{
    if (!ImGui::GetCurrentContext())
        return;
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void weft_ui_begin(void)
{
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    hear_mouse();
    ImGui::NewFrame();
    const ImVec2 moved = ImGui::GetIO().MouseDelta;
    if (moved.x != 0 || moved.y != 0 || ImGui::IsAnyMouseDown())
        pointer_moved_s = ImGui::GetTime();
}

bool weft_ui_is_behind(void)
{
    return !waiting.empty();
}

void weft_ui_end(void)
{
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool weft_ui_holds_mouse(void)
{
    const ImGuiPopupFlags any = ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel;
    return ImGui::IsAnyItemActive() || ImGui::IsPopupOpen("", any);
}

bool weft_ui_wants_keyboard(void)
{
    return ImGui::GetIO().WantTextInput;
}

void weft_ui_panel_begin(const char *name, double x, double y, double width, double height)
{
    ImGui::SetNextWindowPos(ImVec2((float)x, (float)y));
    ImGui::SetNextWindowSize(ImVec2((float)width, (float)height));
    wrap_at = 0;
    ImGui::Begin(name, nullptr, fixed);
}

void weft_ui_note_begin(const char *name, double x, double y, double share_x, double share_y)
{
    ImGui::SetNextWindowPos(ImVec2((float)x, (float)y), ImGuiCond_Always, ImVec2((float)share_x, (float)share_y));
    ImGui::SetNextWindowBgAlpha(0.92f);
    /* A note is as wide as its text, so its text cannot wrap where the note ends: it wraps within the picture. */
    const float before = (float)x / std::max((float)share_x, 0.01f),
                after = (ImGui::GetIO().DisplaySize.x - (float)x) / std::max(1 - (float)share_x, 0.01f);
    wrap_at = std::min(scaled(widest_note), std::max(scaled(narrowest_note), std::min(before, after) - scaled(64)));
    if (room_for)
        ImGui::SetNextWindowSizeConstraints(size_of_note(room_for), ImVec2(FLT_MAX, FLT_MAX));
    room_for = nullptr;
    ImGui::Begin(name, nullptr,
                 fixed | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoInputs);
}

void weft_ui_room_for(const char *text)
{
    room_for = text;
}

void weft_ui_wrap_within(double width)
{
    wrap_at = std::min(wrap_at, std::max(scaled(narrowest_note), (float)width - ImGui::GetStyle().WindowPadding.x));
}

void weft_ui_list(const char *name, const weft_ui_entry *line, size_t count, size_t middle, const weft_ui_box *room)
{
    const ImVec2 size((float)room->width, (float)room->height), padding = ImGui::GetStyle().WindowPadding;
    list_shape shape = shape_of(line, count, middle);
    const ImVec2 free(size.x - 2 * padding.x - scaled(16), size.y - 2 * padding.y - scaled(16));
    if (width_of(shape) > free.x / smallest_list)
        shape = shape_of(line, count, count);
    const float letters =
        std::max(smallest_list, std::min({1.0f, free.x / width_of(shape), free.y / height_of(shape)}));
    ImGui::SetNextWindowPos(ImVec2((float)room->x + size.x / 2, (float)room->y + size.y / 2), ImGuiCond_Always,
                            ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowSize(ImVec2(std::min(width_of(shape) * letters + 2 * padding.x + scaled(12), size.x),
                                    std::min(height_of(shape) * letters + 2 * padding.y, size.y)));
    ImGui::SetNextWindowBgAlpha(0.94f);
    ImGui::Begin(name, nullptr, fixed);
    ImGui::SetWindowFontScale(letters);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0, shape.spacing * letters));
    put_column(line, shape.middle, shape.name * letters);
    ImGui::SameLine(0, shape.gap * letters);
    put_column(line + shape.middle, count - shape.middle, shape.name * letters);
    ImGui::PopStyleVar();
    ImGui::End();
}

void weft_ui_panel_end(void)
{
    ImGui::End();
}

bool weft_ui_section(const char *name, bool open_at_first)
{
    ImGui::Separator();
    return ImGui::CollapsingHeader(name, open_at_first ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

void weft_ui_same_line(void)
{
    ImGui::SameLine();
}

void weft_ui_gap(void)
{
    ImGui::Dummy(ImVec2(0, scaled(4)));
}

void weft_ui_disable(bool disabled)
{
    ImGui::BeginDisabled(disabled);
}

void weft_ui_enable(void)
{
    ImGui::EndDisabled();
}

void weft_ui_heading(const char *text)
{
    ImGui::PushStyleColor(ImGuiCol_Text, accent);
    weft_ui_text(text);
    ImGui::PopStyleColor();
}

void weft_ui_text(const char *text)
{
    ImGui::PushTextWrapPos(wrap_at);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
}

void weft_ui_dim_text(const char *text)
{
    ImGui::PushStyleColor(ImGuiCol_Text, dim);
    weft_ui_text(text);
    ImGui::PopStyleColor();
}

void weft_ui_swatch(uint32_t colour, const char *meaning)
{
    const float side = ImGui::GetFontSize();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddRectFilled(corner, ImVec2(corner.x + side, corner.y + side), colour_of(colour),
                                              scaled(3));
    ImGui::Dummy(ImVec2(side, side));
    ImGui::SameLine();
    ImGui::TextUnformatted(meaning);
}

void weft_ui_value(const char *label, const char *value)
{
    put_label(label);
    ImGui::TextUnformatted(value);
    ImGui::PopID();
}

bool weft_ui_button(const char *label)
{
    const bool pressed = ImGui::Button(label);
    show_hint(label);
    return pressed;
}

bool weft_ui_entry_chosen(const char *label, const char *whole)
{
    /* The label is text of its own: within that of a widget "##" would end it. */
    const ImVec2 place = ImGui::GetCursorPos();
    ImGui::PushID(whole);
    const bool chosen = ImGui::Selectable("##entry");
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s", whole);
    ImGui::SetCursorPos(place);
    ImGui::TextUnformatted(label);
    ImGui::PopID();
    return chosen;
}

bool weft_ui_toggle(const char *label, bool *value)
{
    const bool changed = ImGui::Checkbox(label, value);
    show_hint(label);
    return changed;
}

bool weft_ui_slider(const char *label, double *value, double low, double high, const char *format, bool logarithmic)
{
    put_label(label);
    bool changed = ImGui::SliderScalar("##slider", ImGuiDataType_Double, value, &low, &high, format,
                                       logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
    ImGui::PopID();
    show_hint(label);
    if (changed)
        *value = std::min(std::max(*value, low), high);
    return changed;
}

bool weft_ui_angle(const char *label, double *value_rad, double low_deg, double high_deg)
{
    const double degree = 3.14159265358979323846 / 180;
    double value_deg = *value_rad / degree;
    bool changed = weft_ui_slider(label, &value_deg, low_deg, high_deg, "%.1f\xc2\xb0", false);
    if (changed)
        *value_rad = value_deg * degree;
    return changed;
}

bool weft_ui_whole(const char *label, int *value, int low, int high)
{
    put_label(label);
    bool changed = ImGui::SliderInt("##whole", value, low, high);
    ImGui::PopID();
    show_hint(label);
    if (changed)
        *value = std::min(std::max(*value, low), high);
    return changed;
}

bool weft_ui_whole_input(const char *label, int *value, int low, int high)
{
    int typed = *value;
    put_label(label);
    bool edited = ImGui::InputInt("##whole", &typed);
    ImGui::PopID();
    show_hint(label);
    typed = std::min(std::max(typed, low), high);
    if (!edited || typed == *value)
        return false;
    *value = typed;
    return true;
}

bool weft_ui_choice(const char *label, int *value, const char *const *name, const bool *allowed, int count)
{
    bool changed = false;
    put_label(label);
    const float gap = scaled(3), room = ImGui::GetContentRegionAvail().x - gap * (float)(count - 1);
    float letters = 0;
    for (int i = 0; i < count; i++)
        letters += ImGui::CalcTextSize(name[i]).x;
    for (int i = 0; i < count; i++) {
        bool chosen = *value == i;
        if (i > 0)
            ImGui::SameLine(0, gap);
        ImGui::PushID(i);
        ImGui::BeginDisabled(allowed && !allowed[i]);
        if (chosen)
            ImGui::PushStyleColor(ImGuiCol_Button, accent);
        ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(0, ImGui::GetStyle().FramePadding.y));
        const float width = ImGui::CalcTextSize(name[i]).x + (room - letters) / (float)count;
        if (ImGui::Button(name[i], ImVec2(width, 0)) && !chosen) {
            *value = i;
            changed = true;
        }
        ImGui::PopStyleVar();
        if (chosen)
            ImGui::PopStyleColor();
        ImGui::EndDisabled();
        show_hint(name[i]);
        ImGui::PopID();
    }
    ImGui::PopID();
    return changed;
}

bool weft_ui_colour(const char *label, double rgb[3])
{
    float value[3] = {(float)rgb[0], (float)rgb[1], (float)rgb[2]};
    put_label(label);
    bool changed = ImGui::ColorEdit3(
        "##colour", value, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR | ImGuiColorEditFlags_NoOptions);
    ImGui::PopID();
    show_hint(label);
    for (int i = 0; changed && i < 3; i++)
        rgb[i] = std::max(0.0, (double)value[i]);
    return changed;
}

weft_ui_area weft_ui_here(void)
{
    const ImVec2 corner = ImGui::GetCursorScreenPos(), pointer = ImGui::GetIO().MousePos;
    return {corner.x, corner.y, pointer.x, pointer.y, false, false};
}

weft_ui_area weft_ui_drawing(const char *name, double width, double height)
{
    const ImVec2 corner = ImGui::GetCursorScreenPos(), pointer = ImGui::GetIO().MousePos;
    ImGui::InvisibleButton(name, ImVec2((float)width, (float)height));
    return {corner.x, corner.y, pointer.x, pointer.y, ImGui::IsItemHovered(), ImGui::IsItemActive()};
}

void weft_ui_picture(unsigned texture, double width, double height)
{
    ImGui::Image((ImTextureID)(intptr_t)texture, ImVec2((float)width, (float)height), ImVec2(0, 1), ImVec2(1, 0));
}

void weft_ui_disc(double x, double y, double radius, uint32_t colour)
{
    ImGui::GetWindowDrawList()->AddCircleFilled(ImVec2((float)x, (float)y), (float)radius, colour_of(colour), 0);
}

void weft_ui_ring(double x, double y, double radius, double thickness, uint32_t colour)
{
    ImGui::GetWindowDrawList()->AddCircle(ImVec2((float)x, (float)y), (float)radius, colour_of(colour), 64,
                                          (float)thickness);
}

void weft_ui_label(double x, double y, uint32_t colour, const char *text)
{
    ImGui::GetWindowDrawList()->AddText(ImVec2((float)x, (float)y), colour_of(colour), text);
}
