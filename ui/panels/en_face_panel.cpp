#include "ui/panels/en_face_panel.h"

#include <algorithm>
#include <string>
#include <utility>

#include "embedded_shaders.h"

#include "ui/gl/picture_texture.h"
#include "ui/panels/flow_shader.h"
#include "ui/panels/hatch.h"
#include "ui/panels/projection.h"

namespace octascope::ui {

namespace {

constexpr float grey_under_flow = 0.5F;

template <class Value>
bool same_row(std::span<const Value> a, std::span<const Value> b, std::size_t from,
              std::size_t length) {
  return std::ranges::equal(a.subspan(from, length), b.subspan(from, length));
}

} // namespace

hal::Result<EnFacePanel::Passes> EnFacePanel::make(bool flow) {
  const std::string source =
      flow ? seen_from_above(shaders::en_face_frag) : std::string{shaders::en_face_frag};
  HAL_TRY(auto marking, gl::PicturePass::create("en_face", with_hatch(source)));
  HAL_TRY(auto plain, gl::PicturePass::create("en_face, all good", all_good(source)));
  if (flow)
    for (const gl::PicturePass* pass : {&marking, &plain})
      set_flow_from_above(pass->program());
  return Passes{Pass{std::move(marking)}, Pass{std::move(plain)}};
}

hal::Result<EnFacePanel> EnFacePanel::create() {
  HAL_TRY(auto passes, make(false));
  return EnFacePanel{std::move(passes)};
}

hal::Result<> EnFacePanel::prepare_flow() {
  if (with_flow_)
    return {};
  HAL_TRY(auto passes, make(true));
  with_flow_.emplace(std::move(passes));
  return {};
}

EnFacePanel::Pass::Pass(gl::PicturePass made)
    : pass{std::move(made)}, projection{pass.uniform("u_projection")}, states{pass.uniform(
                                                                           "u_states")},
      corner{pass.uniform("u_corner")}, extent{pass.uniform("u_extent")}, hatch{pass.uniform(
                                                                              "u_hatch")},
      mark_width{pass.uniform("u_mark_width")}, mark{pass.uniform("u_mark")},
      seam{pass.uniform("u_seam")}, flow{pass.uniform("u_flow")}, dimmed{pass.uniform("u_dimmed")},
      tint_place{pass.uniform("u_tint_place")} {}

EnFacePanel::EnFacePanel(Passes passes) : passes_{std::move(passes)} {}

void EnFacePanel::allocate(int a_scans, int b_scans) {
  a_scans_ = a_scans;
  b_scans_ = b_scans;
  levels_.resize(static_cast<std::size_t>(a_scans) * static_cast<std::size_t>(b_scans));
  wanted_.resize(static_cast<std::size_t>(b_scans));
  grey_ = levels_;
  before_.clear();
  projection_ = gl::make_picture_texture(GL_R8, a_scans, b_scans);
  flow_.clear();
  flow_before_.clear();
}

void EnFacePanel::show(const pipeline::Volume& volume, const TissueMap& tissue,
                       std::span<const pipeline::BScanRange> changed, WorkTeam* team,
                       bool with_flow) {
  const bool other = volume.geometry.a_scans != a_scans_ || volume.geometry.b_scans != b_scans_;
  if (other)
    allocate(volume.geometry.a_scans, volume.geometry.b_scans);
  for (int b = 0; b < b_scans_; ++b)
    wanted_[static_cast<std::size_t>(b)] =
        other || changed.empty() || tissue.changed_at(b) ? std::uint8_t{1} : std::uint8_t{0};
  for (const pipeline::BScanRange& range : changed)
    std::fill(wanted_.begin() + range.from, wanted_.begin() + range.to, std::uint8_t{1});
  project_slab(volume, tissue, levels_, wanted_, team);
  std::swap(grey_, before_);
  grey_.assign(levels_.begin(), levels_.end());
  stretch_contrast(volume, grey_);
  flow_before_ = flow_;
  if (with_flow && volume.has_flow())
    show_flow(volume, tissue,
              changed.empty() ? coming_.of(volume) : std::span<const ComingRuns::Run>{}, team);
  else
    flow_.clear();
  compare_rows();
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glBindTexture(GL_TEXTURE_2D, projection_.name());
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, a_scans_, b_scans_, GL_RED, GL_UNSIGNED_BYTE,
                  grey_.data());
}

// Where it is new, in all B-scans.
void EnFacePanel::show_flow(const pipeline::Volume& volume, const TissueMap& tissue,
                            std::span<const ComingRuns::Run> ahead, WorkTeam* team) {
  const bool is_new = flow_.empty();
  flow_.resize(levels_.size());
  project_flow(volume, tissue, flow_, is_new ? std::span<const std::uint8_t>{} : wanted_, ahead,
               team);
  if (!flow_projection_ || is_new)
    flow_projection_ = gl::make_picture_texture(GL_RG8, a_scans_, b_scans_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glBindTexture(GL_TEXTURE_2D, flow_projection_.name());
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, a_scans_, b_scans_, GL_RG, GL_UNSIGNED_BYTE,
                  flow_.data());
}

void EnFacePanel::compare_rows() {
  changed_.assign(static_cast<std::size_t>(b_scans_), 1);
  if (before_.size() != grey_.size() || flow_before_.size() != flow_.size())
    return;
  const auto length = static_cast<std::size_t>(a_scans_);
  for (std::size_t b = 0; b < changed_.size(); ++b) {
    const bool same =
        same_row<std::uint8_t>(grey_, before_, b * length, length) &&
        (flow_.empty() || same_row<FlowFromAbove>(flow_, flow_before_, b * length, length));
    changed_[b] = same ? 0 : 1;
  }
}

void EnFacePanel::set_marks(const Pass& pass, const StateTexture& states, const Rect& rect,
                            int target_height) {
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, states.name());
  glUniform1i(pass.states, 1);
  set_hatch(pass.hatch, rect, target_height);
  glUniform1f(pass.mark_width, mark_share);
  set_colour(pass.mark, palette::warning);
  set_colour(pass.seam, palette::seam);
}

void EnFacePanel::draw(const StateTexture& states, const Crop& crop, const Rect& rect,
                       int target_height, std::optional<float> deepest_flow) const {
  const bool flow = deepest_flow && with_flow_ && !flow_.empty();
  const Passes& passes = flow ? *with_flow_ : passes_;
  const Pass& with = states.all_good() ? passes.plain : passes.marking;
  with.pass.use();
  if (!states.all_good())
    set_marks(with, states, rect, target_height);
  if (flow) {
    glActiveTexture(GL_TEXTURE2);
    glBindTexture(GL_TEXTURE_2D, flow_projection_.name());
    glUniform1i(with.flow, 2);
    glUniform1f(with.dimmed, grey_under_flow);
    glUniform2f(with.tint_place, 1 / std::max(*deepest_flow, 1e-3F), 0);
  }
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, projection_.name());
  glUniform1i(with.projection, 0);
  glUniform2f(with.corner, crop.a.from, crop.b.from);
  glUniform2f(with.extent, crop.a.length(), crop.b.length());
  with.pass.fill(rect, target_height);
}

} // namespace octascope::ui
