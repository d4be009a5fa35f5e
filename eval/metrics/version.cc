namespace depthgrid {}
