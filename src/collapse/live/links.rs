//! Upkeep of the incidence lists of a live mesh, face by face.

use super::{EdgeRecord, Incident, LiveMesh, NONE};

impl LiveMesh {
    pub(super) fn link_face(&mut self, id: u32, corners: [u32; 3]) {
        self.faces[id as usize] = corners;
        for v in corners {
            self.faces_at.push(v, id);
        }
        self.live += 1;
    }

    pub(super) fn unlink_face(&mut self, id: u32) {
        for v in self.faces[id as usize] {
            self.faces_at.remove(v, id);
        }
        self.faces[id as usize] = [NONE; 3];
        self.live -= 1;
    }

    pub(super) fn add_side(&mut self, a: u32, b: u32, created: &mut Vec<u32>) {
        if let Some(e) = self.find_edge(a, b) {
            self.edges[e as usize].faces += 1;
            return;
        }
        let ends = [a.min(b), a.max(b)];
        let record = EdgeRecord { ends, faces: 1 };
        let id = match self.free_edges.pop() {
            Some(id) => {
                self.edges[id as usize] = record;
                id
            }
            None => {
                self.edges.push(record);
                (self.edges.len() - 1) as u32
            }
        };
        for (v, other) in [(a, b), (b, a)] {
            self.edges_at.push(v, Incident { other, edge: id });
        }
        created.push(id);
    }

    pub(super) fn remove_side(&mut self, a: u32, b: u32, deleted: &mut Vec<u32>) {
        let Some(id) = self.find_edge(a, b) else {
            return;
        };
        self.edges[id as usize].faces -= 1;
        if self.edges[id as usize].faces > 0 {
            return;
        }
        for (v, other) in [(a, b), (b, a)] {
            self.edges_at.remove(v, Incident { other, edge: id });
        }
        self.edges[id as usize].ends = [NONE; 2];
        self.free_edges.push(id);
        deleted.push(id);
    }
}
