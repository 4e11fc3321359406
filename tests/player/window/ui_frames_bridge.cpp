#include "tests/player/window/ui_frames_bridge.h"

#include <imgui/imgui.h>
#include <imgui/imgui_internal.h>

void ui_frames_open(double width, double height)
{
    unsigned char *pixels;
    int across, down;
    ImGui::CreateContext();
    ImGuiIO &io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2((float)width, (float)height);
    io.DeltaTime = 0.5f;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &across, &down);
}

void ui_frames_close(void)
{
    ImGui::DestroyContext();
}

void ui_frames_begin(void)
{
    ImGui::NewFrame();
}

void ui_frames_point(double x, double y)
{
    ImGui::GetIO().MousePos = ImVec2((float)x, (float)y);
}

void ui_frames_end(const char *name, double *width, double *height)
{
    const ImGuiWindow *window = ImGui::FindWindowByName(name);
    const bool is_there = window && window->Active;
    *width = is_there ? (double)window->Size.x : 0;
    *height = is_there ? (double)window->Size.y : 0;
    ImGui::EndFrame();
}

double ui_frames_top(const char *name)
{
    return (double)ImGui::FindWindowByName(name)->Pos.y;
}
