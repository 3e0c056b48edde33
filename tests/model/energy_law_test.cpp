// What a front takes back of the energy that its contacts made.
#include <doctest/doctest.h>

#include "model/rigid/energy_law.h"

using topple::rigid::EnergyLaw;

TEST_CASE("energy law: what energy falls is not given back, and what it rises beyond what is allowed is taken") {
  EnergyLaw law;
  CHECK(law.excess(10.0, 0.5) == 0.0);  // Nothing to compare with yet.
  CHECK(law.excess(8.0, 0.5) == 0.0);
  CHECK(law.excess(8.25, 0.5) == 0.0);
  CHECK(law.excess(9.0, 0.5) == 0.5);  // Of a rise of 1 since it was least; 8.5 is left.
  CHECK(law.excess(8.5, 0.5) == 0.0);
  CHECK(law.excess(8.75, 0.5) == 0.25);
  CHECK(law.excess(7.0, 0.5) == 0.0);
  CHECK(law.excess(7.5, 0.5) == 0.0);
}

TEST_CASE("energy law: a brick that begins to move or comes to rest is no rise and no fall") {
  EnergyLaw law;
  law.excess(4.0, 0.5);
  law.add(3.0);
  CHECK(law.excess(7.0, 0.5) == 0.0);
  law.add(-6.0);
  CHECK(law.excess(1.0, 0.5) == 0.0);
  CHECK(law.excess(2.0, 0.5) == 0.5);
}

TEST_CASE("energy law: a push may raise the energy, but the rise before it still counts") {
  EnergyLaw law;
  law.excess(1.0, 0.5);
  CHECK(law.excess(1.25, 0.5) == 0.0);
  law.forget();
  CHECK(law.excess(9.0, 0.5) == 0.0);
  CHECK(law.excess(9.5, 0.5) == 0.25);
}

TEST_CASE("energy law: two fronts that join have both their energies and both their rises") {
  EnergyLaw one, other;
  one.excess(1.0, 0.5);
  one.excess(1.25, 0.5);
  other.excess(2.0, 0.5);
  other.excess(2.25, 0.5);
  one.join(other);
  CHECK(one.excess(3.5, 0.5) == 0.0);
  CHECK(one.excess(3.75, 0.5) == 0.25);
}
