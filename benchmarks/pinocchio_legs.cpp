// Newton's method with Pinocchio on the legs of a parallel machine, for `pinocchio_compiled.py`.
//
// The legs are branches of one tree on the ground, three joints each; the ball at the end of a
// branch closes on a point that the tool's pose gives. One call of `computeJointJacobians` gives
// where the branches are and their rates; each leg's three equations are then solved by Eigen.

#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/multibody.hpp>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace {

using Matrix3 = Eigen::Matrix3d;
using Vector3 = Eigen::Vector3d;

struct Legs {
    pinocchio::Model model;
    pinocchio::Data data;
    std::vector<pinocchio::JointIndex> last;
    std::vector<Vector3> ends;
    std::vector<int> driven;
};

void add(pinocchio::Model& model, pinocchio::JointIndex& parent, int kind, const double* at) {
    const Matrix3 turn = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(at + 3);
    const pinocchio::SE3 place(turn, Vector3(at[0], at[1], at[2]));
    const auto name = "q" + std::to_string(model.njoints);
    const auto joint = [&]() -> pinocchio::JointModel {
        switch (kind) {
            case 0: return pinocchio::JointModelPX();
            case 1: return pinocchio::JointModelPY();
            case 2: return pinocchio::JointModelPZ();
            case 3: return pinocchio::JointModelRX();
            case 4: return pinocchio::JointModelRY();
            default: return pinocchio::JointModelRZ();
        }
    }();
    parent = model.addJoint(parent, joint, place, name);
}

}  // namespace

extern "C" {

// kinds: 0 to 5 for x, y, z, rx, ry, rz, three a leg; places: position and rotation of each in
// its parent's axes; ends: of each branch, in its last joint's axes; driven: coordinates.
void* legs_make(int legs, const int* kinds, const double* places, const double* ends, int drives,
                const int* driven) {
    auto* made = new Legs();
    for (int leg = 0; leg < legs; ++leg) {
        pinocchio::JointIndex parent = 0;
        for (int k = 3 * leg; k < 3 * leg + 3; ++k) add(made->model, parent, kinds[k], places + 12 * k);
        made->last.push_back(parent);
        made->ends.emplace_back(ends[3 * leg], ends[3 * leg + 1], ends[3 * leg + 2]);
    }
    made->data = pinocchio::Data(made->model);
    made->driven.assign(driven, driven + drives);
    return made;
}

void legs_free(void* legs) { delete static_cast<Legs*>(legs); }

// Where the balls must be (poses, legs, 3) and the tool (poses, 3) give coordinates
// (poses, 3 legs) and rates of the drives by the tool's twist (poses, drives, 6), row by row.
// Poses that stay open are marked 0 in `closed`.
void legs_solve(void* handle, std::int64_t poses, const double* wanted, const double* tool,
                double accuracy, int most, double* coordinates, double* rates,
                std::uint8_t* closed) {
    auto& l = *static_cast<Legs*>(handle);
    const int legs = static_cast<int>(l.last.size());
    const int drives = static_cast<int>(l.driven.size());
    Eigen::VectorXd q(3 * legs);
    std::vector<Matrix3> inverse(legs);
    for (std::int64_t pose = 0; pose < poses; ++pose) {
        q.setZero();
        const double* points = wanted + 3 * legs * pose;
        closed[pose] = 0;
        for (int step = 0; step < most; ++step) {
            pinocchio::computeJointJacobians(l.model, l.data, q);
            double gap = 0.0;
            for (int leg = 0; leg < legs; ++leg) {
                const Vector3 end = l.data.oMi[l.last[leg]].act(l.ends[leg]);
                const Vector3 left = Eigen::Map<const Vector3>(points + 3 * leg) - end;
                const auto block = l.data.J.middleCols<3>(3 * leg);
                Matrix3 m;
                for (int k = 0; k < 3; ++k)
                    m.col(k) = block.col(k).head<3>() + block.col(k).tail<3>().cross(end);
                inverse[leg] = m.inverse();
                q.segment<3>(3 * leg) += inverse[leg] * left;
                gap = std::max(gap, left.cwiseAbs().maxCoeff());
            }
            if (gap <= accuracy) {
                closed[pose] = 1;
                break;
            }
        }
        Eigen::Map<Eigen::VectorXd>(coordinates + 3 * legs * pose, 3 * legs) = q;
        const Vector3 centre(tool[3 * pose], tool[3 * pose + 1], tool[3 * pose + 2]);
        for (int d = 0; d < drives; ++d) {
            const int leg = l.driven[d] / 3;
            const Vector3 row = inverse[leg].row(l.driven[d] % 3);
            const Vector3 arm = Eigen::Map<const Vector3>(points + 3 * leg) - centre;
            double* out = rates + 6 * (drives * pose + d);
            const Vector3 turn = arm.cross(row);
            std::copy_n(row.data(), 3, out);
            std::copy_n(turn.data(), 3, out + 3);
        }
    }
}
}
