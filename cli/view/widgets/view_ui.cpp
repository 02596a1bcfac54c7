#include "cli/view/widgets/view_ui.h"

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <cstdio>
#include <exception>
#include <map>
#include <string>

namespace {

struct rectangle {
  float x, y, width, height;
  int frame;
};
std::map<std::string, rectangle> places;
std::string sought;
bool in_panel;

ImU32 colour_of(abbe_ui_colour c) {
  return IM_COL32(c >> 16 & 255, c >> 8 & 255, c & 255, 255 - (c >> 24 & 255));
}

ImVec4 vector_of(abbe_ui_colour c) {
  return ImGui::ColorConvertU32ToFloat4(colour_of(c));
}

ImDrawList *list() {
  return in_panel ? ImGui::GetWindowDrawList() : ImGui::GetBackgroundDrawList();
}

ImVec2 at(double x, double y) {
  return ImVec2(static_cast<float>(x), static_cast<float>(y));
}

/* Dear ImGui 1.86 takes the state of keys, 1.89 and later take events. */
#if IMGUI_VERSION_NUM >= 18900
void give_input(ImGuiIO &io, const abbe_ui_input &input) {
  io.ConfigInputTrickleEventQueue = false; /* all of a frame's input counts in that frame */
  io.AddKeyEvent(ImGuiMod_Shift, input.shift);
  io.AddKeyEvent(ImGuiMod_Ctrl, input.control);
  io.AddKeyEvent(ImGuiKey_Enter, input.enter);
  io.AddKeyEvent(ImGuiKey_Backspace, input.backspace);
  io.AddKeyEvent(ImGuiKey_Escape, input.escape);
  io.AddMousePosEvent(static_cast<float>(input.mouse[0]), static_cast<float>(input.mouse[1]));
  for (int i = 0; i < 3; i++) io.AddMouseButtonEvent(i, input.button[i]);
  io.AddMouseWheelEvent(0, static_cast<float>(input.wheel));
}

bool escape_is_pressed() {
  return ImGui::IsKeyPressed(ImGuiKey_Escape);
}
#else
void give_input(ImGuiIO &io, const abbe_ui_input &input) {
  io.KeyShift = input.shift;
  io.KeyCtrl = input.control;
  io.KeyMap[ImGuiKey_Enter] = 1;
  io.KeyMap[ImGuiKey_Backspace] = 2;
  io.KeyMap[ImGuiKey_Escape] = 3;
  io.KeysDown[1] = input.enter;
  io.KeysDown[2] = input.backspace;
  io.KeysDown[3] = input.escape;
  io.MousePos = at(input.mouse[0], input.mouse[1]);
  for (int i = 0; i < 3; i++) io.MouseDown[i] = input.button[i];
  io.MouseWheel = static_cast<float>(input.wheel);
}

bool escape_is_pressed() {
  return ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
}
#endif

bool font_has(ImWchar character) {
#if IMGUI_VERSION_NUM >= 19200
  return ImGui::GetFont()->IsGlyphInFont(character);
#else
  return ImGui::GetFont()->FindGlyphNoFallback(character) != nullptr;
#endif
}

/* A label that is seen as a whole, and an id: Dear ImGui hides what stands behind "##", and takes
 * what stands behind "###" alone for the id. Between them is a space that has no width. */
std::string whole(const char *label) {
  const bool there = font_has(0x200b);
  std::string out;
  for (; *label != '\0'; label++) {
    if (*label == '#' && !out.empty() && out.back() == '#') out += there ? "\u200b" : " ";
    out += *label;
  }
  return out;
}

/* Keeps where the last widget is. */
void note(const char *label) {
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
  if (sought == label) {
    ImGui::SetScrollHereY(0.5F);
    sought.clear();
  }
  if (ImGui::IsItemVisible())
    places[label] = {from.x, from.y, to.x - from.x, to.y - from.y, ImGui::GetFrameCount()};
}

void dress() {
  ImGuiStyle &s = ImGui::GetStyle();
  ImGui::StyleColorsDark();
  s.WindowRounding = 0;
  s.FrameRounding = 3;
  s.GrabRounding = 3;
  s.WindowBorderSize = 0;
  s.WindowPadding = ImVec2(14, 12);
  s.ItemSpacing = ImVec2(8, 6);
  s.FramePadding = ImVec2(7, 4);
  s.ScrollbarSize = 10;
  const struct {
    ImGuiCol which;
    abbe_ui_colour colour;
  } colours[] = {{ImGuiCol_WindowBg, 0x16181c},
                 {ImGuiCol_PopupBg, 0x1d2026},
                 {ImGuiCol_Text, 0xd6d9de},
                 {ImGuiCol_TextDisabled, 0x858b95},
                 {ImGuiCol_FrameBg, 0x262a31},
                 {ImGuiCol_FrameBgHovered, 0x30353e},
                 {ImGuiCol_FrameBgActive, 0x363c47},
                 {ImGuiCol_SliderGrab, 0x46587a},
                 {ImGuiCol_SliderGrabActive, 0x5a7099},
                 {ImGuiCol_Button, 0x2b3038},
                 {ImGuiCol_ButtonHovered, 0x3a414c},
                 {ImGuiCol_ButtonActive, 0x47505e},
                 {ImGuiCol_Header, 0x1f2329},
                 {ImGuiCol_HeaderHovered, 0x2a2f37},
                 {ImGuiCol_HeaderActive, 0x323842},
                 {ImGuiCol_ScrollbarBg, 0x16181c},
                 {ImGuiCol_ScrollbarGrab, 0x343a44},
                 {ImGuiCol_Separator, 0x2a2e35}};
  for (const auto &c : colours) s.Colors[c.which] = vector_of(c.colour);
}

void load_font() {
  static const ImWchar ranges[] = {0x20,   0xff,   0x370,  0x3ff,  0x2000, 0x206f,
                                   0x2070, 0x209f, 0x2190, 0x22ff, 0};
  static const char path[] = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  ImFontAtlas *fonts = ImGui::GetIO().Fonts;
  std::FILE *there = std::fopen(path, "rb");
  if (there != nullptr) std::fclose(there);
  if (there == nullptr || fonts->AddFontFromFileTTF(path, 14, nullptr, ranges) == nullptr)
    fonts->AddFontDefault();
}

} // namespace

abbe_result abbe_ui_make(abbe_error *error) {
  try {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::GetIO().LogFilename = nullptr;
    dress();
    load_font();
    if (ImGui_ImplOpenGL3_Init("#version 450 core")) return ABBE_OK;
    ImGui::DestroyContext();
    return abbe_error_set(error, ABBE_GL, "the viewer's widgets find no OpenGL to draw with");
  } catch (const std::exception &e) {
    return abbe_error_set(error, ABBE_GL, "the viewer's widgets: %s", e.what());
  }
}

void abbe_ui_free(void) {
  if (ImGui::GetCurrentContext() == nullptr) return;
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext();
  places.clear();
}

void abbe_ui_begin(const abbe_ui_input *input) {
  ImGuiIO &io = ImGui::GetIO();
  io.DisplaySize = at(input->width, input->height);
  io.DeltaTime = input->seconds > 1e-4 ? static_cast<float>(input->seconds) : 1e-4F;
  give_input(io, *input);
  io.AddInputCharactersUTF8(input->text);
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
}

void abbe_ui_end(void) {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool abbe_ui_has_pointer(void) {
  return ImGui::GetIO().WantCaptureMouse;
}

bool abbe_ui_has_keys(void) {
  return ImGui::GetIO().WantTextInput;
}

void abbe_ui_panel_begin(const char *name, double x, double y, double width, double height) {
  ImGui::SetNextWindowPos(at(x, y));
  ImGui::SetNextWindowSize(at(width, height));
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoBackground);
  ImGui::PushItemWidth(ImGui::GetWindowWidth() * 0.56F);
  in_panel = true;
}

void abbe_ui_panel_end(void) {
  ImGui::PopItemWidth();
  ImGui::End();
  in_panel = false;
}

bool abbe_ui_section(const char *label, bool open) {
  const bool is_open = ImGui::CollapsingHeader(
      whole(label).c_str(), open ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None);
  note(label);
  return is_open;
}

void abbe_ui_text(abbe_ui_colour colour, const char *text) {
  ImGui::PushStyleColor(ImGuiCol_Text, vector_of(colour));
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text);
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

void abbe_ui_pair(const char *name, const char *value) {
  const float column = ImGui::GetWindowWidth() * 0.46F;
  ImGui::TextDisabled("%s", name);
  ImGui::SameLine(ImGui::GetItemRectSize().x + 20 < column ? column : 0);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(value);
  ImGui::PopTextWrapPos();
}

void abbe_ui_scope_begin(const char *id) {
  ImGui::PushID(whole(id).c_str());
}

void abbe_ui_scope_end(void) {
  ImGui::PopID();
}

void abbe_ui_gap(void) {
  ImGui::Spacing();
}

void abbe_ui_beside(void) {
  ImGui::SameLine();
}

bool abbe_ui_button(const char *label) {
  const bool pressed = ImGui::Button(whole(label).c_str());
  note(label);
  return pressed;
}

bool abbe_ui_slider(const char *label, double *value, double min, double max, const char *format,
                    bool logarithmic, bool *began) {
  const ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat |
                                 (logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
  const bool changed = ImGui::SliderScalar(whole(label).c_str(), ImGuiDataType_Double, value, &min,
                                           &max, format, flags);
  note(label);
  places[label].width = ImGui::CalcItemWidth(); /* without the label */
  if (began != nullptr) *began = ImGui::IsItemActivated();
  return changed;
}

bool abbe_ui_tip(const char *text) {
  if (!ImGui::IsItemHovered()) return false;
  ImGui::SetTooltip("%s", text);
  return true;
}

bool abbe_ui_choose(const char *label, const char *const *names, const abbe_ui_colour *colours,
                    size_t count, size_t *index) {
  bool chosen = false;
  const bool known = *index < count && names[*index] != nullptr;
  const std::string now = whole(known ? names[*index] : "");
  const bool open =
      ImGui::BeginCombo(whole(label).c_str(), now.c_str(), ImGuiComboFlags_HeightLarge);
  if (!open) {
    note(label);
    const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
    const float side = to.y - from.y, right = from.x + ImGui::CalcItemWidth() - side;
    if (colours != nullptr && known) /* left of the arrow */
      list()->AddRectFilled(ImVec2(right - side + 5, from.y + 5), ImVec2(right - 5, to.y - 5),
                            colour_of(colours[*index]));
    return false;
  }
  for (size_t i = 0; i < count; i++) {
    if (names[i] == nullptr) {
      ImGui::Separator();
      continue;
    }
    if (colours != nullptr) {
      const ImVec2 corner = ImGui::GetCursorScreenPos();
      const float side = ImGui::GetTextLineHeight();
      list()->AddRectFilled(corner, ImVec2(corner.x + side, corner.y + side),
                            colour_of(colours[i]));
      ImGui::Dummy(ImVec2(side, side));
      ImGui::SameLine();
    }
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::Selectable(whole(names[i]).c_str(), i == *index)) {
      *index = i;
      chosen = true;
    }
    ImGui::PopID();
    note(names[i]);
  }
  if (escape_is_pressed()) ImGui::CloseCurrentPopup();
  ImGui::EndCombo();
  return chosen;
}

bool abbe_ui_place(const char *label, double width, double height, double *x, double *y) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton(whole(label).c_str(), at(width, height));
  note(label);
  *x = corner.x;
  *y = corner.y;
  return ImGui::IsItemVisible();
}

double abbe_ui_panel_width(void) {
  return ImGui::GetContentRegionAvail().x;
}

void abbe_ui_clip(double width, double height) {
  list()->PushClipRect(at(0, 0), at(width, height));
}

void abbe_ui_line(double x0, double y0, double x1, double y1, abbe_ui_colour colour, double width) {
  list()->AddLine(at(x0, y0), at(x1, y1), colour_of(colour), static_cast<float>(width));
}

void abbe_ui_circle(double x, double y, double radius, abbe_ui_colour colour, double width) {
  list()->AddCircle(at(x, y), static_cast<float>(radius), colour_of(colour), 0,
                    static_cast<float>(width));
}

void abbe_ui_box(double x0, double y0, double x1, double y1, abbe_ui_colour colour) {
  list()->AddRectFilled(at(x0, y0), at(x1, y1), colour_of(colour));
}

void abbe_ui_label(double x, double y, abbe_ui_colour colour, const char *text) {
  list()->AddText(at(x, y), colour_of(colour), text);
}

bool abbe_ui_find(const char *label, double *x, double *y, double *width, double *height) {
  const auto found = places.find(label);
  if (found == places.end() || found->second.frame < ImGui::GetFrameCount() - 1) return false;
  const rectangle &r = found->second;
  *x = r.x;
  *y = r.y;
  *width = r.width;
  *height = r.height;
  return true;
}

void abbe_ui_seek(const char *label) {
  sought = label;
}
