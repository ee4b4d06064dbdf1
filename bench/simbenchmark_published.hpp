/// Published rows of SimBenchmark (Hwangbo, Kang; github.com/leggedrobotics/SimBenchmark, data/*/sample.csv and
/// data/rolling/default.csv): error reduction parameter off, one solver of each engine. Its CPU times are of its
/// authors' machine.
#pragma once

namespace bin_scenes::bench {

struct Published {
  const char *scene, *engine, *solver;
  double time_step_s, error, cpu_s;
};

// clang-format off
constexpr Published simbenchmark_rows[] = {
    {"666", "ODE", "quick", 0.0004, 2.42059e-05, 35.0435},
    {"666", "MuJoCo", "Newton", 0.0004, 0.0391936, 88.4944},
    {"666", "ODE", "quick", 0.001, 0.000157122, 10.0378},
    {"666", "MuJoCo", "Newton", 0.001, 0.0950124, 43.1372},
    {"666", "ODE", "quick", 0.004, 0.00208149, 2.52893},
    {"666", "MuJoCo", "Newton", 0.004, 0.374245, 15.3103},
    {"666", "ODE", "quick", 0.01, 0.0161901, 1.00332},
    {"666", "MuJoCo", "Newton", 0.01, 0.933766, 5.1182},
    {"666", "Bullet", "multibody", 0.0004, 0.0629953, 27.8013},
    {"666", "Bullet", "multibody", 0.001, 0.38247, 11.9778},
    {"666", "Bullet", "multibody", 0.004, 5.78282, 4.14151},
    {"666", "Bullet", "multibody", 0.01, 37.4217, 2.01153},
    {"666", "RaiSim", "bisection", 0.0004, 2.36103e-05, 3.38443},
    {"666", "RaiSim", "bisection", 0.001, 0.00013534, 1.51045},
    {"666", "RaiSim", "bisection", 0.004, 0.00211391, 0.38779},
    {"666", "RaiSim", "bisection", 0.01, 0.0152745, 0.167983},
    {"666", "DART", "Dantzig", 0.0004, 0.00717582, 37.6985},
    {"666", "DART", "Dantzig", 0.001, 0.000282356, 22.9162},
    {"666", "DART", "Dantzig", 0.004, 9292.72, 6.56869},
    {"666", "DART", "Dantzig", 0.01, 214.842, 3.06581},
    {"elastic_666", "Bullet", "multibody", 0.0004, 3563.92, 5.93753},
    {"elastic_666", "Bullet", "multibody", 0.001, 41498.1, 2.31772},
    {"elastic_666", "Bullet", "multibody", 0.004, 840066, 0.65147},
    {"elastic_666", "Bullet", "multibody", 0.01, 9.86396e+06, 0.31976},
    {"elastic_666", "ODE", "quick", 0.0004, 17.5054, 13.8713},
    {"elastic_666", "ODE", "quick", 0.001, 112.318, 5.64728},
    {"elastic_666", "ODE", "quick", 0.004, 1648.4, 1.43055},
    {"elastic_666", "ODE", "quick", 0.01, 8.55999e+06, 0.601697},
    {"elastic_666", "RaiSim", "bisection", 0.0004, 0.248699, 1.64278},
    {"elastic_666", "RaiSim", "bisection", 0.001, 8.36835, 0.655143},
    {"elastic_666", "RaiSim", "bisection", 0.004, 264.072, 0.180666},
    {"elastic_666", "RaiSim", "bisection", 0.01, 5.18417e+06, 0.0702891},
    {"elastic_666", "DART", "Dantzig", 0.0004, 52414.7, 20.386},
    {"elastic_666", "DART", "Dantzig", 0.001, 346909, 8.05873},
    {"elastic_666", "DART", "Dantzig", 0.004, 6.62224e+06, 1.9544},
    {"elastic_666", "DART", "Dantzig", 0.01, 1.28706e+10, 0.842985},
    {"bouncing", "ODE", "quick", 0.0004, 29.631, 4.60098},
    {"bouncing", "DART", "Dantzig", 0.0004, 10870.7, 8.00361},
    {"bouncing", "ODE", "quick", 0.001, 185.027, 1.88695},
    {"bouncing", "DART", "Dantzig", 0.001, 72274.4, 3.2084},
    {"bouncing", "ODE", "quick", 0.004, 2982.68, 0.473906},
    {"bouncing", "DART", "Dantzig", 0.004, 1.18966e+06, 0.795548},
    {"bouncing", "ODE", "quick", 0.01, 18808.3, 0.189298},
    {"bouncing", "DART", "Dantzig", 0.01, 7.37588e+06, 0.338765},
    {"bouncing", "Bullet", "multibody", 0.0004, 12038.5, 2.07987},
    {"bouncing", "Bullet", "multibody", 0.001, 75245.4, 0.851648},
    {"bouncing", "Bullet", "multibody", 0.004, 1.20178e+06, 0.226891},
    {"bouncing", "Bullet", "multibody", 0.01, 7.40664e+06, 0.102335},
    {"bouncing", "RaiSim", "bisection", 0.0004, 0.000477103, 0.601746},
    {"bouncing", "RaiSim", "bisection", 0.001, 0.0186204, 0.235136},
    {"bouncing", "RaiSim", "bisection", 0.004, 4.76468, 0.0610991},
    {"bouncing", "RaiSim", "bisection", 0.01, 185.953, 0.0252509},
    {"rolling", "RaiSim", "bisection", 0.001, 4.13711e-07, 0.308104},
    {"rolling", "Bullet", "multibody", 0.001, 5.70654e-09, 0.561834},
    {"rolling", "ODE", "quick", 0.001, 3.14497, 0.724026},
    {"rolling", "MuJoCo", "Newton", 0.001, 0.00692691, 1.67194},
    {"rolling", "DART", "Dantzig", 0.001, 3.14497, 2.67552},
};
// clang-format on

}  // namespace bin_scenes::bench
