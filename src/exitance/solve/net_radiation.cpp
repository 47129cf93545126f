// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/net_radiation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/math/conjugate_gradients.h"
#include "exitance/run/error.h"

namespace exitance {

namespace {

// A row that lacks less than this sees no surroundings: float rounding of a closed row.
constexpr double closed_share = 1e-5;

double blackbody(double temperature) {
    return stefan_boltzmann * std::pow(temperature, 4);
}

class Exchange {
  public:
    Exchange(const FormFactorMatrix& F, std::span<const ThermalSurface> given, double surroundings,
             const std::vector<std::string>& names)
        : A_(F.areas()),
          S_(symmetrised(F)),
          given_(given),
          names_(names),
          sky_(blackbody(surroundings)),
          open_(A_.size()),
          J_(A_.size()) {
        const std::vector<double> seen = S_.times(std::vector<double>(A_.size(), 1.0));
        for (std::size_t i = 0; i < A_.size(); ++i) {
            const double share = 1 - seen[i] / A_[i];
            open_[i] = share > closed_share ? share * A_[i] : 0;
        }
        check();
    }

    NetRadiation solve() {
        solve_radiosities();
        NetRadiation out;
        const std::vector<double> arrived = S_.times(J_);
        for (std::size_t i = 0; i < A_.size(); ++i) {
            RadiatingSurface s;
            s.radiosity = J_[i];
            s.irradiation = (arrived[i] + open_[i] * sky_) / A_[i];
            s.heat_flux = s.radiosity - s.irradiation;
            s.heat = s.heat_flux * A_[i];
            s.temperature = temperature(i, s);
            out.lost += open_[i] * (J_[i] - sky_);
            out.imbalance += s.heat;
            out.surfaces.push_back(s);
        }
        out.imbalance -= out.lost;
        return out;
    }

  private:
    void check() const {
        bool level = std::any_of(open_.begin(), open_.end(), [](double a) { return a > 0; });
        for (std::size_t i = 0; i < A_.size(); ++i) {
            const ThermalSurface& s = given_[i];
            if (s.temperature.has_value() == s.heat_flux.has_value())
                throw Error(Fault::bad_input,
                            fmt::format("'{}' has {} a temperature {} a heat flux, expected one "
                                        "of them",
                                        names_[i], s.temperature ? "both" : "neither",
                                        s.temperature ? "and" : "nor"));
            if (s.heat_flux && *s.heat_flux != 0 && s.emissivity == 0)
                throw Error(Fault::bad_input,
                            fmt::format("'{}' has a heat flux and emissivity 0: it cannot send "
                                        "heat out",
                                        names_[i]));
            level |= s.temperature && s.emissivity > 0;
        }
        if (!level)
            throw Error(Fault::bad_input,
                        "no surface has a temperature and nothing is lost: the level of the "
                        "others is not determined");
    }

    // M J = b with M = diag − S, each row times its area: diag = A/ρ where the temperature is
    // given, A where the heat is. Symmetric and positive. Black surfaces' J is known, they are left
    // out.
    void solve_radiosities() {
        const std::size_t n = A_.size();
        std::vector<double> diagonal(n), full(n), b(n), x(n);
        std::vector<char> known(n, 0);
        for (std::size_t i = 0; i < n; ++i) {
            const ThermalSurface& s = given_[i];
            const double rho = 1 - s.emissivity;
            known[i] = s.temperature && rho == 0;
            if (known[i]) J_[i] = blackbody(*s.temperature);
            if (known[i]) continue;
            full[i] = s.temperature ? A_[i] / rho : A_[i];
            b[i] = open_[i] * sky_ + (s.temperature
                                          ? A_[i] * s.emissivity / rho * blackbody(*s.temperature)
                                          : A_[i] * *s.heat_flux);
            diagonal[i] = std::max(full[i] - S_.at(i, i), 1e-6 * full[i]);
        }
        const std::vector<double> from_black = S_.times(J_);
        for (std::size_t i = 0; i < n; ++i) {
            if (!known[i])
                b[i] += from_black[i];
            else
                diagonal[i] = 1;
        }
        const double left = conjugate_gradients(
            [&](const std::vector<double>& in) {
                std::vector<double> out = S_.times(in);
                for (std::size_t i = 0; i < n; ++i)
                    out[i] = known[i] ? 0 : full[i] * in[i] - out[i];
                return out;
            },
            diagonal, b, x, 1e-12, 20 * n + 100);
        if (!(left <= 1e-6))
            throw Error(Fault::could_not_finish,
                        fmt::format("the radiosities did not converge, {:.1g} is left", left));
        for (std::size_t i = 0; i < n; ++i)
            if (!known[i]) J_[i] = x[i];
    }

    double temperature(std::size_t i, const RadiatingSurface& s) const {
        if (given_[i].temperature) return *given_[i].temperature;
        const double emissivity = given_[i].emissivity;
        if (emissivity == 0) return std::numeric_limits<double>::quiet_NaN();
        // q = ε/(1 − ε) (E_b − J).
        const double emissive = s.radiosity + s.heat_flux * (1 - emissivity) / emissivity;
        if (emissive < -1e-9 * std::abs(s.radiosity))
            throw Error(Fault::bad_input,
                        fmt::format("'{}' cannot take in so much heat: even at 0 K less arrives",
                                    names_[i]));
        return std::pow(std::max(0.0, emissive) / stefan_boltzmann, 0.25);
    }

    const std::vector<double>& A_;
    ExchangeAreas S_;
    std::span<const ThermalSurface> given_;
    const std::vector<std::string>& names_;
    double sky_;
    std::vector<double> open_;  // A_i (1 − Σ F_ij)
    std::vector<double> J_;
};

}  // namespace

double largest_opening(const FormFactorMatrix& F) {
    double most = 0;
    F.for_rows([&](std::size_t, std::span<const FormFactorMatrix::Entry> entries) {
        double sum = 0;
        for (const auto& e : entries) sum += static_cast<double>(e.value);
        most = std::max(most, 1 - sum);
    });
    return most > closed_share ? most : 0;
}

NetRadiation net_radiation(const FormFactorMatrix& F, std::span<const ThermalSurface> surfaces,
                           double surroundings, const std::vector<std::string>& names) {
    return Exchange(F, surfaces, surroundings, names).solve();
}

}  // namespace exitance
