#ifndef sabot_materials_elastic_base_h
#define sabot_materials_elastic_base_h

#include "sabot/materials/material.h"

#include <functional>

namespace sabot
{
/** Density and isotropic elasticity, shared by all laws. */
struct ElasticConstants
{
  double density = 0.;       // [kg/m^3]
  double young_modulus = 0.; // [Pa]
  double poisson_ratio = 0.;

  double bulk_modulus() const
  {
    return young_modulus / (3. * (1. - 2. * poisson_ratio));
  }
  double shear_modulus() const
  {
    return young_modulus / (2. * (1. + poisson_ratio));
  }
  static void declare_parameters(dealii::ParameterHandler &prm);
  /** Also checks that the sound speed is plausible, 100 to 20 000 m/s. */
  static ElasticConstants parse(const dealii::ParameterHandler &prm,
                                const std::string &path);
};

class ElasticBase : public Material
{
public:
  explicit ElasticBase(const ElasticConstants &c)
      : constants(c), K(c.bulk_modulus()), G(c.shear_modulus())
  {
  }
  double density() const override { return constants.density; }
  double bulk_modulus() const override { return K; }
  double shear_modulus() const override { return G; }

protected:
  /** Deviator <- deviator + 2 G dev(dE) and pressure -K ln J, for all points;
      the stress arrays then hold the trial stress. */
  void trial_stress(const MaterialBatch &batch) const;

  const ElasticConstants constants;
  const double K, G;
};

/** A law that scenes can name. A law's file registers it. */
struct MaterialModel
{
  std::string name, description;
  std::function<void(dealii::ParameterHandler &)> declare;
  std::function<std::unique_ptr<Material>(dealii::ParameterHandler &,
                                          const std::string &path)>
      make;
};
std::vector<MaterialModel> &material_models();
struct RegisterMaterial
{
  explicit RegisterMaterial(const MaterialModel &model);
};
} // namespace sabot

#endif
