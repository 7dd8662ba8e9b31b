// The variation operators of a real-coded genetic algorithm over a box.
#pragma once

#include <vector>

#include "core/random/draws.h"

namespace dispersa {

/// Simulated binary crossover of one variable of two parents, in place. The children lie about the parents
/// with a polynomial distribution of index eta. It is cut at the bounds, so no child leaves them. K. Deb and
/// R. B. Agrawal, "Simulated binary crossover for continuous search space", Complex Systems 9 (1995) 115-148;
/// the bounded form as in Deb (2000), see feasibility_rules.h. Draws two numbers.
void CrossOver(double* a, double* b, double lower, double upper, double eta, Stream* stream);

/// The same with one spread for all variables: the children lie on the line through the parents, in place.
/// Unlike crossover by variable it does not depend on the axes, and so follows narrow valleys and feasible
/// regions that are oblique to them. This is the extended line recombination of H. Muehlenbein and
/// D. Schlierkamp-Voosen, "Predictive models for the breeder genetic algorithm", Evolutionary Computation 1
/// (1993) 25-49, with the distribution of simulated binary crossover. All shapes (n). Draws one number.
void CrossOverOnLine(std::vector<double>* a, std::vector<double>* b, const std::vector<double>& lower,
                     const std::vector<double>& upper, double eta, Stream* stream);

/// `x` after a polynomial mutation of index eta, cut at the bounds. The larger eta, the smaller the change.
/// K. Deb and M. Goyal, "A combined genetic adaptive search (GeneAS) for engineering design", Computer
/// Science and Informatics 26 (1996) 30-45; bounded form as in Deb (2000). Draws one number.
double Mutated(double x, double lower, double upper, double eta, Stream* stream);

}  // namespace dispersa
