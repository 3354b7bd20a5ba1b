// Furniture made of simple solids.
#pragma once

#include "learn/scenes/draft.h"

namespace odis::learn {

Piece makeTable(Draft& draft, float width, float depth, float height);
Piece makeRoundTable(Draft& draft, float radius, float height);
Piece makeChair(Draft& draft);
Piece makeStool(Draft& draft);
// Open, its boards full of books and small things to a degree.
Piece makeShelf(Draft& draft, float width, float height);
Piece makeCabinet(Draft& draft, float width, float height);
Piece makeSofa(Draft& draft, float width);
Piece makeBed(Draft& draft, float width);
Piece makePlant(Draft& draft, float height);
Piece makeCrates(Draft& draft);

// Stands on something: books, bowls, bottles, balls, boxes, a plant.
Piece makeOrnament(Draft& draft, float most);
// Puts some ornaments on a top of a piece.
void decorate(Draft& draft, Piece& piece, double density);

// A flat picture or mirror to hang: its back at y = 0, its middle in the origin.
Piece makePicture(Draft& draft, float width, float height, MaterialId front);

// A model of the user's of about this height at most, in one of the sizes and colours that it names; nothing
// (no parts) if there is none that suits. Wide ones stand against walls.
Piece makeModel(Draft& draft, const Vec3& most, bool ornament);

}  // namespace odis::learn
