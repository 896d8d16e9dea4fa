#include "control/ik/kinematics.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "world/model_memory.h"

namespace gloam::ik {
namespace {

struct KindRow {
  FrameKind kind;
  const char* word;
  mjtObj type;
};
constexpr KindRow kKinds[] = {{FrameKind::kBody, "body", mjOBJ_BODY},
                              {FrameKind::kSite, "site", mjOBJ_SITE},
                              {FrameKind::kGeom, "geom", mjOBJ_GEOM}};

const KindRow& row_of(FrameKind kind) { return *std::ranges::find(kKinds, kind, &KindRow::kind); }

}  // namespace

Result<FrameName> parse_frame(std::string_view text) {
  const size_t space = text.find(' ');
  const std::string word(text.substr(0, space));
  const auto row = std::ranges::find(kKinds, word, &KindRow::word);
  const std::string name(space == std::string_view::npos ? "" : text.substr(space + 1));
  if (row == std::end(kKinds) || name.empty()) {
    return Error{ErrorKind::kInput,
                 fmt::format("'{:.80}' does not name a frame", text),
                 {},
                 "write \"site NAME\", \"body NAME\" or \"geom NAME\""};
  }
  return FrameName{row->kind, name};
}

Transform to_transform(const Pose& X) {
  return {Eigen::Quaterniond(X.q.w, X.q.x, X.q.y, X.q.z).normalized().toRotationMatrix(),
          {X.p.x, X.p.y, X.p.z}};
}

int FrameId::body(const mjModel& model) const {
  switch (kind) {
    case FrameKind::kSite:
      return model.site_bodyid[id];
    case FrameKind::kGeom:
      return model.geom_bodyid[id];
    case FrameKind::kBody:
      break;
  }
  return id;
}

Result<int> find_element(const mjModel& model, mjtObj type, const char* what,
                         const std::string& name) {
  const int id = mj_name2id(&model, type, name.c_str());
  if (id >= 0) return id;
  std::vector<std::string> names;
  const int count = type == mjOBJ_BODY   ? model.nbody
                    : type == mjOBJ_SITE ? model.nsite
                    : type == mjOBJ_GEOM ? model.ngeom
                                         : model.njnt;
  for (int i = 0; i < count; ++i)
    if (const char* text = mj_id2name(&model, type, i)) names.emplace_back(text);
  return Error{ErrorKind::kInput,
               fmt::format("the model has no {} '{:.80}'", what, name),
               {},
               suggest_name(name, names)};
}

Result<FrameId> find_frame(const mjModel& model, const FrameName& name) {
  const KindRow& row = row_of(name.kind);
  GLOAM_TRY(const int id, find_element(model, row.type, row.word, name.name));
  return FrameId{name.kind, id};
}

Kinematics::Kinematics(const mjModel& model, std::vector<int> dofs)
    : model_(&model),
      data_(make_data(model)),
      dofs_(std::move(dofs)),
      full_(6, static_cast<Eigen::Index>(model.nv)) {}

Kinematics::Kinematics(const Kinematics& other) : Kinematics(*other.model_, other.dofs_) {
  set_mocap(*other.data_);
  update(other.data_->qpos);
}

void Kinematics::update(const double* qpos) {
  mju_copy(data_->qpos, qpos, static_cast<int>(model_->nq));
  mj_kinematics(model_, data_.get());
  mj_comPos(model_, data_.get());
}

void Kinematics::set_mocap(const mjData& source) {
  mju_copy(data_->mocap_pos, source.mocap_pos, static_cast<int>(3 * model_->nmocap));
  mju_copy(data_->mocap_quat, source.mocap_quat, static_cast<int>(4 * model_->nmocap));
}

Transform pose_of(const mjData& data, const FrameId& frame) {
  const double* p = data.xpos;
  const double* R = data.xmat;
  if (frame.kind == FrameKind::kSite) p = data.site_xpos, R = data.site_xmat;
  if (frame.kind == FrameKind::kGeom) p = data.geom_xpos, R = data.geom_xmat;
  return {Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(R + 9 * frame.id),
          Eigen::Map<const Vector3d>(p + 3 * frame.id)};
}

void Kinematics::body_jacobian(const FrameId& frame, MatrixXd& J_B) {
  const Transform X_WB = pose(frame);
  double* rows = full_.data();
  mj_jac(model_, data_.get(), rows, rows + 3 * model_->nv, X_WB.p.data(), frame.body(*model_));
  for (int i = 0; i < size(); ++i) {
    J_B.col(i).head<3>() = X_WB.R.transpose() * full_.col(dofs_[i]).head<3>();
    J_B.col(i).tail<3>() = X_WB.R.transpose() * full_.col(dofs_[i]).tail<3>();
  }
}

void Kinematics::point_jacobian(int body, const Vector3d& p_W, MatrixXd& J_W) {
  mj_jac(model_, data_.get(), full_.data(), nullptr, p_W.data(), body);
  for (int i = 0; i < size(); ++i) J_W.col(i) = full_.col(dofs_[i]).head<3>();
}

void Kinematics::com_jacobian(int body, MatrixXd& J_W) {
  mj_jacSubtreeCom(model_, data_.get(), full_.data(), body);
  for (int i = 0; i < size(); ++i) J_W.col(i) = full_.col(dofs_[i]).head<3>();
}

}  // namespace gloam::ik
